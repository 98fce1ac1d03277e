// One test body for every DeviceLink: an emulated board in this process, the same below libusb, a recording of it that
// is played back, and a real board where GRAVURE_TEST_BOARD has its serial number (its gate opens: lines are run).

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "emulated_usb_board.hpp"
#include "gravure/emulator/emulated_link.hpp"
#include "gravure/fpga/register_map.hpp"
#include "gravure/protocol/frame.hpp"
#include "gravure/protocol/start_sequence.hpp"
#include "gravure/protocol/status_message.hpp"
#include "gravure/replay/recording_link.hpp"
#include "gravure/replay/replay_link.hpp"
#include "gravure/usb/usb_link.hpp"
#include "mock_bus.hpp"

namespace gravure {
namespace {

using namespace std::chrono_literals;
using Body = std::function<void(DeviceLink&)>;

constexpr std::chrono::milliseconds kLong = 20s;
constexpr std::uint32_t kLines = 6;

DeviceSetup small_job() {
  DeviceSetup setup;
  setup.clock_multiplier = static_cast<std::int64_t>(fpga::kClockMultiplierRegister.reset);
  setup.ticks_per_slot = 20;
  setup.slots_per_line = 40;
  setup.window_slots = 11;
  setup.lines_per_revolution = 4;
  return setup;
}

void write(DeviceLink& link, const std::vector<protocol::RegisterWrite>& writes) {
  for (const protocol::RegisterWrite& each : writes) {
    const auto written = link.write_register(each.address, each.value);
    ASSERT_TRUE(written) << written.error().message;
  }
}

std::vector<std::byte> frames(std::uint32_t lines) {
  std::vector<std::byte> stream;
  const std::vector<std::byte> bits{std::byte{0xA5}, std::byte{0x40}};
  for (std::uint32_t line = 0; line < lines; ++line) {
    protocol::append_frame(stream, {line, line / 4, line % 4, 9}, bits);
  }
  return stream;
}

void send_all(DeviceLink& link, std::span<const std::byte> stream) {
  const auto sent = link.send(stream, kLong);
  ASSERT_TRUE(sent) << sent.error().message;
  ASSERT_EQ(sent.value(), stream.size());
  const auto drained = link.drain(kLong);
  ASSERT_TRUE(drained && drained.value());
}

/// The first status that fits.
BoardStatus wait_for(DeviceLink& link, const std::function<bool(const BoardStatus&)>& fits) {
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  while (std::chrono::steady_clock::now() < deadline) {
    const auto status = link.next_status(100ms);
    if (!status) {
      ADD_FAILURE() << status.error().message;
      return {};
    }
    if (status.value() && fits(*status.value())) {
      return *status.value();
    }
  }
  ADD_FAILURE() << "no such status in time";
  return {};
}

void acknowledge(DeviceLink& link) {
  write(link, {{fpga::kControlRegister.address, 0}, {fpga::kCommandRegister.address, protocol::kCommandAcknowledge}});
}

/// Where a link to the test's board comes from, and how often the body talks to it.
class AnyLink : public testing::TestWithParam<std::string> {
 protected:
  AnyLink() : folder_(std::filesystem::temp_directory_path() / ("gravure_any_link_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~AnyLink() override { std::filesystem::remove_all(folder_); }

  void run(const Body& body) {
    if (GetParam() == "emulated") {
      body(*emulated());
    } else if (GetParam() == "usb") {
      on_usb(body);
    } else if (GetParam() == "replay") {
      on_replay(body);
    } else {
      on_board(body);
    }
  }

 private:
  static emulator::EmulatedBoard board() {
    emulator::BoardOptions options;
    options.serial = "ANY-1";
    return emulator::EmulatedBoard(options);
  }
  static std::unique_ptr<DeviceLink> emulated() { return std::make_unique<emulator::EmulatedLink>(board()); }
  static void on_usb(const Body& body) {
    test::EmulatedUsbBoard below(board());  // outlives the bus, whose thread serves it to the end
    auto bus = test::MockBus::create();
    ASSERT_TRUE(bus) << bus.error().message;
    bus.value()->plug(below, {.serial = "ANY-1"});
    const auto link = usb::open_usb_link({});
    ASSERT_TRUE(link) << link.error().message;
    body(*link.value());
  }
  void on_replay(const Body& body) {
    const std::string path = (folder_ / "session.txt").string();
    const auto recording = replay::RecordingLink::create(emulated(), path);
    ASSERT_TRUE(recording) << recording.error().message;
    body(*recording.value());
    const auto played = replay::ReplayLink::open(path);
    ASSERT_TRUE(played) << played.error().message;
    body(*played.value());
    EXPECT_TRUE(played.value()->at_end());
  }
  static void on_board(const Body& body) {
    const char* const serial = std::getenv("GRAVURE_TEST_BOARD");
    if (serial == nullptr) {
      GTEST_SKIP() << "no board: GRAVURE_TEST_BOARD has no serial number of one whose gate may open";
    }
    const auto link = usb::open_usb_link({.serial = serial});
    ASSERT_TRUE(link) << link.error().message;
    body(*link.value());
  }

  std::filesystem::path folder_;
};

TEST_P(AnyLink, SaysWhichBoardItIs) {
  run([](DeviceLink& link) {
    EXPECT_FALSE(link.identity().serial.empty());
    EXPECT_FALSE(link.identity().product.empty());
    EXPECT_FALSE(link.identity().place.empty());
    EXPECT_EQ(link.identity().protocol_version, protocol::kProtocolVersion);
  });
}

TEST_P(AnyLink, RegistersAreReadAsTheyWereWritten) {
  run([](DeviceLink& link) {
    EXPECT_EQ(link.read_register(fpga::kMagicRegister.address).value(), fpga::kMagicRegister.reset);
    EXPECT_EQ(link.read_register(fpga::kVersionRegister.address).value(), fpga::kVersionRegister.reset);
    acknowledge(link);
    for (const std::uint32_t value : {1U, 4321U, (1U << 24U) - 1U}) {
      write(link, {{fpga::kSlotsPerLineRegister.address, value}});
      EXPECT_EQ(link.read_register(fpga::kSlotsPerLineRegister.address).value(), value);
    }
  });
}

TEST_P(AnyLink, ABoardSaysWhatItHolds) {
  run([](DeviceLink& link) {
    acknowledge(link);
    const BoardStatus status = wait_for(link, [](const BoardStatus& one) { return one.state == BoardState::idle; });
    EXPECT_EQ(status.protocol_version, protocol::kProtocolVersion);
    EXPECT_EQ(status.fault, DeviceFault::none);
    EXPECT_GE(status.capacity_bytes, 4096U);
    EXPECT_EQ(status.level_bytes, 0U);
  });
}

TEST_P(AnyLink, LinesThatAreSentAreExecuted) {
  run([](DeviceLink& link) {
    const auto sequence = protocol::start_sequence(small_job(), {});
    ASSERT_TRUE(sequence) << sequence.error().message;
    write(link, sequence.value().settings);
    write(link, sequence.value().prepare);
    const auto stream = frames(kLines);
    send_all(link, stream);
    const BoardStatus filled = wait_for(link, [&](const BoardStatus& one) {
      return one.state == BoardState::filling && (one.level_bytes == stream.size() || one.taken_lines == kLines);
    });
    EXPECT_EQ(filled.executed_lines, 0U);
    write(link, sequence.value().start);
    const BoardStatus done = wait_for(link, [](const BoardStatus& one) { return one.executed_lines == kLines; });
    EXPECT_EQ(done.taken_lines, kLines);
    EXPECT_EQ(done.level_bytes, 0U);
    EXPECT_EQ(done.revolution, 1U);
    EXPECT_EQ(done.line, 2U);
    acknowledge(link);
  });
}

TEST_P(AnyLink, AFrameThatIsDamagedStopsTheBoardUntilAcknowledged) {
  run([](DeviceLink& link) {
    const auto sequence = protocol::start_sequence(small_job(), {});
    ASSERT_TRUE(sequence) << sequence.error().message;
    write(link, sequence.value().settings);
    write(link, sequence.value().prepare);
    auto stream = frames(2);
    stream.back() ^= std::byte{1};
    send_all(link, stream);
    const BoardStatus stopped = wait_for(link, [](const BoardStatus& one) { return one.state == BoardState::stopped; });
    EXPECT_EQ(stopped.fault, DeviceFault::checksum);
    EXPECT_TRUE(stopped.gate_dark);
    EXPECT_EQ(stopped.executed_lines, 0U);
    ASSERT_TRUE(link.abandon());
    acknowledge(link);
    const BoardStatus again = wait_for(link, [](const BoardStatus& one) { return one.state != BoardState::stopped; });
    EXPECT_EQ(again.fault, DeviceFault::none);
    EXPECT_EQ(again.level_bytes, 0U);
  });
}

INSTANTIATE_TEST_SUITE_P(, AnyLink, testing::Values("emulated", "usb", "replay", "board"),
                         [](const auto& kind) { return kind.param; });

}  // namespace
}  // namespace gravure
