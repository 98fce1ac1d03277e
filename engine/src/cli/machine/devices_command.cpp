#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "gravure/usb/boards.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

constexpr std::uint64_t kMostWaitSeconds = 86'400;

Json json_of(const usb::BoardReport& board) {
  const DeviceIdentity& identity = board.identity;
  Json out = {{"serial", identity.serial},
              {"product", identity.product},
              {"place", identity.place},
              {"link_bits_per_s", identity.link_bits_per_s}};
  out["protocol_version"] = board.status ? Json(identity.protocol_version) : Json();
  out["register_map"] = board.register_map ? Json(*board.register_map) : Json();
  out["state"] = board.status ? Json(to_string(board.status->state)) : Json();
  out["fault"] = board.status ? Json(to_string(board.status->fault)) : Json();
  out["executed_lines"] = board.status ? Json(board.status->executed_lines) : Json();
  out["problem"] = board.problem.empty() ? Json() : Json(board.problem);
  return out;
}

std::string text_of(const usb::BoardReport& board) {
  std::string text = board.identity.serial.empty() ? "?" : board.identity.serial;
  text += fmt::format(": {} on {}", board.identity.product.empty() ? "board" : board.identity.product,
                      board.identity.place);
  if (board.status) {
    text += fmt::format(", protocol {}", board.identity.protocol_version);
  }
  if (board.register_map) {
    text += fmt::format(", register map {}", *board.register_map);
  }
  if (board.status) {
    text += ", " + to_string(board.status->state);
    text += board.status->fault == DeviceFault::none ? "" : " by " + to_string(board.status->fault);
    text += fmt::format(", {} lines executed", board.status->executed_lines);
  }
  return text + "\n" + (board.problem.empty() ? "" : "  cannot be used: " + board.problem + "\n");
}

Result<int> run_devices(const Command& command, std::int64_t wait_s) {
  if (wait_s > 0) {
    CancelToken& cancel = cancel_token();
    GRAVURE_CHECK(usb::wait_for_board("", std::chrono::seconds(wait_s), [&] { return cancel.cancelled(); }));
  }
  GRAVURE_TRY(const std::vector<usb::BoardReport> boards, usb::list_boards());
  if (command.json) {
    Json list = Json::array();
    for (const usb::BoardReport& board : boards) {
      list.push_back(json_of(board));
    }
    print_json({{"boards", list}});
    return kDone;
  }
  std::string text = boards.empty() ? "no board (USB 1209:0001) is plugged in\n" : "";
  for (const usb::BoardReport& board : boards) {
    text += printable(text_of(board));
  }
  print(text);
  return kDone;
}

}  // namespace

void add_devices(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "devices", "Boards on the USB, their state, and what is wrong with them");
  const auto wait_s = std::make_shared<std::int64_t>(0);
  verb->add_option("--wait-s", *wait_s, "Wait so many seconds for a board to be plugged in")
      ->check(integer_from(0, kMostWaitSeconds));
  verb->callback([&command, wait_s] { command.run = [&command, wait_s] { return run_devices(command, *wait_s); }; });
}

}  // namespace gravure::cli
