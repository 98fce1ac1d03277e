// with_usb_board [--board DIR[,key=value...]]... [--fault
// ENDPOINT:KIND[,skip=N][,bytes=N][,transfers=N][,delay_ms=N]]...
//                [--plug-after-ms N] COMMAND ARGUMENT...
// Runs a command, as it is, with a USB of its own on which there are these emulated boards and nothing else; without
// --board none. Faults strike the first board. Ends as the command does; 77 where there is no libumockdev-preload.

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <list>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "emulated_usb_board.hpp"
#include "gravure/emulator/board_name.hpp"
#include "mock_bus.hpp"

namespace {

using namespace gravure;
using namespace gravure::test;
using Kind = UsbFault::Kind;

constexpr int kSkipped = 77;
constexpr int kUsage = 2;

volatile sig_atomic_t command_pid = 0;

extern "C" void pass_on(int signal) {
  if (command_pid > 0) {
    kill(command_pid, signal);
  }
}

[[noreturn]] void give_up(const std::string& why, int status = kUsage) {
  std::fprintf(stderr, "with_usb_board: %s\n", why.c_str());
  std::exit(status);
}

template <class T>
T or_give_up(Result<T> result, int status = kUsage) {
  if (!result) {
    give_up(result.error().message, status);
  }
  return std::move(result).value();
}

std::size_t number_of(std::string_view text) {
  std::size_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) {
    give_up("\"" + std::string(text) + "\" is no number");
  }
  return value;
}

Kind kind_of(const std::string& name) {
  static const std::map<std::string, Kind> kKinds{
      {"stall", Kind::stall},         {"cut_short", Kind::cut_short}, {"never", Kind::never}, {"babble", Kind::babble},
      {"bus_error", Kind::bus_error}, {"refuse", Kind::refuse},       {"delay", Kind::delay}, {"hold", Kind::hold},
      {"corrupt", Kind::corrupt},     {"lose", Kind::lose},           {"twice", Kind::twice}, {"unplug", Kind::unplug}};
  const auto found = kKinds.find(name);
  if (found == kKinds.end()) {
    give_up("\"" + name + "\" is no fault");
  }
  return found->second;
}

struct PlannedFault {
  std::uint8_t endpoint = 0;
  UsbFault fault;
};

PlannedFault fault_of(std::string_view text) {
  const auto part = [&](char end) {
    const std::size_t length = std::min(text.find(end), text.size());
    const std::string_view front = text.substr(0, length);
    text.remove_prefix(std::min(length + 1, text.size()));
    return front;
  };
  PlannedFault planned;
  planned.endpoint = static_cast<std::uint8_t>(number_of(part(':')));
  planned.fault.kind = kind_of(std::string(part(',')));
  while (!text.empty()) {
    const std::string_view key = part('=');
    const std::size_t value = number_of(part(','));
    if (key == "skip") {
      planned.fault.skip = value;
    } else if (key == "bytes") {
      planned.fault.bytes = value;
    } else if (key == "transfers") {
      planned.fault.transfers = value;
    } else if (key == "delay_ms") {
      planned.fault.delay = std::chrono::milliseconds(value);
    } else {
      give_up("\"" + std::string(key) + "\" is nothing of a fault");
    }
  }
  return planned;
}

struct Request {
  std::vector<std::string> boards;
  std::vector<PlannedFault> faults;
  std::chrono::milliseconds plug_after{0};
  char** command = nullptr;
};

Request request_of(char** argument) {
  Request request;
  for (; *argument != nullptr && std::string_view(*argument).substr(0, 2) == "--"; argument += 2) {
    const std::string_view option = *argument;
    if (argument[1] == nullptr) {
      give_up(std::string(option) + " needs a value");
    }
    if (option == "--board") {
      request.boards.emplace_back(argument[1]);
    } else if (option == "--fault") {
      request.faults.push_back(fault_of(argument[1]));
    } else if (option == "--plug-after-ms") {
      request.plug_after = std::chrono::milliseconds(number_of(argument[1]));
    } else {
      give_up(std::string(option) + " is no option");
    }
  }
  request.command = argument;
  if (*request.command == nullptr) {
    give_up("a command is missing");
  }
  return request;
}

/// The command's process, which sees the same bus.
pid_t start(char** command) {
  setenv("LD_PRELOAD", "libumockdev-preload.so.0", 1);
  const char* const sanitizer = std::getenv("ASAN_OPTIONS");
  const std::string options = (sanitizer != nullptr ? std::string(sanitizer) + ":" : "") + "verify_asan_link_order=0";
  setenv("ASAN_OPTIONS", options.c_str(), 1);
  pid_t pid = 0;
  if (posix_spawnp(&pid, *command, nullptr, nullptr, command, environ) != 0) {
    give_up(std::string(*command) + ": cannot be started", 127);
  }
  return pid;
}

int status_of(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  constexpr int kBySignal = 128;
  return WIFEXITED(status) ? WEXITSTATUS(status) : kBySignal + WTERMSIG(status);
}

int run(const Request& request) {
  std::list<EmulatedUsbBoard> boards;  // outlive the bus, whose threads serve them to the end
  auto bus = MockBus::create();
  if (!bus) {
    give_up(bus.error().message, kSkipped);
  }
  for (const std::string& text : request.boards) {
    const emulator::BoardName name = or_give_up(emulator::parse_board_name(text));
    boards.emplace_back(or_give_up(emulator::EmulatedBoard::open(name.folder, name.options), 3));
  }
  const auto plug_all = [&] {
    bool first = true;
    for (EmulatedUsbBoard& board : boards) {
      MockBus::Plug plug;
      plug.serial = board.board().options().serial;
      auto& device = bus.value()->plug(board, plug);
      for (const PlannedFault& planned : request.faults) {
        if (first) {
          device.inject(planned.endpoint, planned.fault);
        }
      }
      first = false;
    }
  };
  if (request.plug_after.count() == 0) {
    plug_all();
  }
  command_pid = start(request.command);
  for (const int signal : {SIGINT, SIGTERM}) {  // whoever stops this wants the command stopped
    struct sigaction action = {};
    action.sa_handler = pass_on;
    sigaction(signal, &action, nullptr);
  }
  std::thread later;
  if (request.plug_after.count() > 0) {
    later = std::thread([&] {
      std::this_thread::sleep_for(request.plug_after);
      plug_all();
    });
  }
  const int status = status_of(command_pid);
  if (later.joinable()) {
    later.join();
  }
  bus.value().reset();  // before the boards behind it
  return status;
}

}  // namespace

int main(int /*argc*/, char** argv) {
  return run(request_of(argv + 1));
}
