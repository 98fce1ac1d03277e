#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "dice.hpp"
#include "gravure/emulator/board_name.hpp"
#include "gravure/emulator/emulated_board.hpp"
#include "gravure/emulator/fired_lines.hpp"
#include "recorder.hpp"
#include "wire_host.hpp"

namespace gravure::emulator {
namespace {

namespace fs = std::filesystem;

class BoardInAFolder : public testing::Test {
 protected:
  BoardInAFolder()
      : root_(fs::temp_directory_path() / ("gravure_board_" + std::to_string(::getpid()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name())),
        folder_((root_ / "board").string()) {
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  ~BoardInAFolder() override { fs::remove_all(root_); }
  Result<EmulatedBoard> open(const std::string& options = "") {
    BoardOptions parsed;
    EXPECT_TRUE(parse_board_options(options, parsed));
    return EmulatedBoard::open(folder_, std::move(parsed));
  }
  static void prepare(EmulatedBoard& board, const DeviceSetup& setup) {
    for (const test::Write& one : test::preparation(setup, 100)) {
      board.write_register(one.address, one.value);
    }
  }
  static void start(EmulatedBoard& board) {
    board.write_register(fpga::kControlRegister.address, test::kRunTimed);
    board.write_register(fpga::kCommandRegister.address, test::kGo);
  }
  struct Fired {
    std::uint32_t revolution;
    std::uint32_t line;
    std::uint32_t first_slot;
    std::vector<std::byte> bits;
  };
  Result<std::vector<Fired>> fired() const {
    std::vector<Fired> lines;
    GRAVURE_CHECK(read_fired_lines(folder_, [&lines](const FiredLine& line) {
      lines.push_back({line.revolution, line.line, line.first_slot, {line.bits.begin(), line.bits.end()}});
      return Result<void>();
    }));
    return lines;
  }
  /// Lines 0 .. count - 1, each once and whole.
  void expect_fired(std::size_t count) const {
    const Result<std::vector<Fired>> lines = fired();
    ASSERT_TRUE(lines) << lines.error().message;
    ASSERT_EQ(lines.value().size(), count);
    for (std::size_t at = 0; at < count; ++at) {
      const test::WireLine expected = test::wire_line(setup_, static_cast<std::int64_t>(at));
      EXPECT_EQ(lines.value()[at].revolution, at / 4);
      EXPECT_EQ(lines.value()[at].line, at % 4);
      EXPECT_EQ(lines.value()[at].first_slot, expected.first_slot);
      EXPECT_EQ(lines.value()[at].bits, expected.bits);
    }
  }
  static std::string contents(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void put(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
  }
  DeviceSetup setup_ = test::wire_setup();
  fs::path root_;
  std::string folder_;
};

TEST_F(BoardInAFolder, KeepsItsNumberAndWhatItFired) {
  std::string serial;
  {
    Result<EmulatedBoard> board = open();
    ASSERT_TRUE(board) << board.error().message;
    serial = board.value().options().serial;
    EXPECT_EQ(serial.substr(0, 3), "EMU");
    prepare(board.value(), setup_);
    start(board.value());
    ASSERT_NE(board.value().take(test::wire_stream(setup_, 0, 11)), 0U);
    board.value().pass_time();
    board.value().write_register(fpga::kControlRegister.address, 0);
  }
  expect_fired(12);
  const Result<EmulatedBoard> board = open();
  ASSERT_TRUE(board) << board.error().message;
  EXPECT_EQ(board.value().options().serial, serial);
  const BoardStatus status = board.value().status();
  EXPECT_EQ(status.power_up, 1U);
  EXPECT_EQ(status.fault, DeviceFault::none) << "it had been stopped";
  EXPECT_EQ(status.executed_lines, 12U);
  expect_fired(12);
}

TEST_F(BoardInAFolder, DoesWhatItHadToDoWithoutItsHost) {
  {
    Result<EmulatedBoard> board = open();
    ASSERT_TRUE(board);
    prepare(board.value(), setup_);
    ASSERT_NE(board.value().take(test::wire_stream(setup_, 0, 6)), 0U);
    start(board.value());
    expect_fired(0);
  }
  Result<EmulatedBoard> board = open();
  ASSERT_TRUE(board) << board.error().message;
  EXPECT_EQ(board.value().status().fault, DeviceFault::underrun);
  EXPECT_EQ(board.value().status().executed_lines, 7U);
  expect_fired(7);
  EXPECT_EQ(board.value().take(test::wire_stream(setup_, 7, 7)), test::kFrame) << "held, not looked at";
  board.value().pass_time();
  expect_fired(7);
}

TEST_F(BoardInAFolder, WaitsForGoWithoutItsHost) {
  {
    Result<EmulatedBoard> board = open();
    ASSERT_TRUE(board);
    prepare(board.value(), setup_);
    ASSERT_NE(board.value().take(test::wire_stream(setup_, 0, 6)), 0U);
  }
  Result<EmulatedBoard> board = open();
  ASSERT_TRUE(board);
  EXPECT_EQ(board.value().status().state, BoardState::filling);
  EXPECT_EQ(board.value().status().taken_lines, 7U);
  start(board.value());
  board.value().pass_time();
  expect_fired(7);
}

TEST_F(BoardInAFolder, RunsOutInItsOwnTimeWhereItsClockRuns) {
  {
    Result<EmulatedBoard> board = open("pace=real,seed_hz=1000");  // a line takes 40 ms, the first comes after 100
    ASSERT_TRUE(board);
    prepare(board.value(), setup_);
    ASSERT_NE(board.value().take(test::wire_stream(setup_, 0, 11)), 0U);
    start(board.value());
  }
  const Result<EmulatedBoard> board = open("pace=wait");
  ASSERT_TRUE(board) << board.error().message;
  EXPECT_EQ(board.value().status().fault, DeviceFault::underrun);
  EXPECT_EQ(board.value().status().executed_lines, 12U);
  expect_fired(12);
}

TEST_F(BoardInAFolder, IsAnotherAfterItsPowerWasGone) {
  {
    Result<EmulatedBoard> board = open("fault=power@line=3+7");
    ASSERT_TRUE(board);
    prepare(board.value(), setup_);
    start(board.value());
    ASSERT_NE(board.value().take(test::wire_stream(setup_, 0, 6)), 0U);
    board.value().pass_time();
    EXPECT_EQ(board.value().status().power_up, 2U);
  }
  {
    Result<EmulatedBoard> board = open();
    ASSERT_TRUE(board);
    EXPECT_EQ(board.value().status().power_up, 2U);
    EXPECT_EQ(board.value().status().state, BoardState::idle);
    board.value().power_cycle();
  }
  const Result<EmulatedBoard> board = open();
  ASSERT_TRUE(board);
  EXPECT_EQ(board.value().status().power_up, 3U);
  ASSERT_TRUE(fired());
  EXPECT_EQ(fired().value().size(), 4U);
}

TEST_F(BoardInAFolder, ForgetsEventsAtAnAcknowledgeButNotTheState) {
  {
    Result<EmulatedBoard> board = open("seed=5");
    ASSERT_TRUE(board);
    for (int job = 0; job < 20; ++job) {
      prepare(board.value(), setup_);
      start(board.value());
      ASSERT_NE(board.value().take(test::wire_stream(setup_, 0, 4)), 0U);
      board.value().pass_time();
    }
    board.value().write_register(fpga::kControlRegister.address, 0);
    board.value().write_register(fpga::kFractionNumRegister.address, 3);
    board.value().write_register(fpga::kFractionNumRegister.address + 1, 1);
    board.value().write_register(fpga::kCommandRegister.address, test::kAcknowledge);
  }
  EXPECT_LT(fs::file_size(folder_ + "/host"), 2000U);
  Result<EmulatedBoard> board = open();
  ASSERT_TRUE(board) << board.error().message;
  EXPECT_EQ(board.value().status().executed_lines, 5U) << "until a position is set";
  EXPECT_EQ(board.value().status().taken_lines, 5U);
  EXPECT_EQ(board.value().status().revolution, 1U);
  EXPECT_EQ(board.value().status().line, 1U);
  EXPECT_EQ(board.value().read_register(fpga::kWindowSlotsRegister.address), 13U);
  EXPECT_EQ(board.value().read_register(fpga::kFractionNumRegister.address), 3U);
  EXPECT_EQ(board.value().read_register(fpga::kFractionNumRegister.address + 1), 1U);
  ASSERT_TRUE(fired());
  EXPECT_EQ(fired().value().size(), 100U);
}

TEST_F(BoardInAFolder, IsLockedAgainstASecondProcess) {
  const Result<EmulatedBoard> first = open();
  ASSERT_TRUE(first);
  const Result<EmulatedBoard> second = open();
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::device);
  EXPECT_NE(second.error().message.find("another process is using this board"), std::string::npos);
}

TEST_F(BoardInAFolder, RefusesToBecomeAnotherBoard) {
  ASSERT_TRUE(open("serial=A,capacity=1000"));
  for (const char* const options : {"serial=B", "capacity=2000", "fifo_bits=12"}) {
    const Result<EmulatedBoard> board = open(options);
    ASSERT_FALSE(board) << options;
    EXPECT_EQ(board.error().code, ErrorCode::bad_argument);
  }
  const Result<EmulatedBoard> board = open("serial=A");
  ASSERT_TRUE(board);
  EXPECT_EQ(board.value().status().capacity_bytes, 1000U);
}

TEST_F(BoardInAFolder, ComesBackWhereverAFileBreaksOff) {
  {
    Result<EmulatedBoard> board = open("seed=9");
    ASSERT_TRUE(board);
    prepare(board.value(), setup_);
    start(board.value());
    std::vector<std::byte> stream = test::wire_stream(setup_, 0, 7);
    stream[6 * test::kFrame + 26] ^= std::byte{0x40};  // closes the gate in a slot that the seed chooses
    ASSERT_NE(board.value().take(stream), 0U);
    board.value().pass_time();
  }
  const std::string lines = contents(folder_ + "/fired");
  const std::string host = contents(folder_ + "/host");
  for (std::size_t size = test::kFrame; size < lines.size(); ++size) {
    put(folder_ + "/host", host);
    put(folder_ + "/fired", lines.substr(0, size));
    const Result<EmulatedBoard> board = open();
    ASSERT_TRUE(board) << size << ": " << board.error().message;
    EXPECT_EQ(contents(folder_ + "/fired"), lines) << size;
    EXPECT_EQ(board.value().status().fault, DeviceFault::checksum);
  }
  put(folder_ + "/fired", lines.substr(0, 16));
  for (std::size_t size = 0; size < host.size(); ++size) {
    put(folder_ + "/host", host.substr(0, size));
    put(folder_ + "/fired", lines.substr(0, 16));
    const Result<EmulatedBoard> board = open();
    const bool begun = size >= 16 + 36 + 100;  // head, begin and its options
    ASSERT_TRUE(board || !begun) << size << ": " << board.error().message;
    if (board) {
      EXPECT_EQ(contents(folder_ + "/fired"), lines.substr(0, contents(folder_ + "/fired").size())) << size;
    } else {
      EXPECT_EQ(board.error().code, ErrorCode::bad_file);
    }
  }
}

TEST_F(BoardInAFolder, RefusesEveryDamage) {
  {
    Result<EmulatedBoard> board = open();
    ASSERT_TRUE(board);
    prepare(board.value(), setup_);
    start(board.value());
    ASSERT_NE(board.value().take(test::wire_stream(setup_, 0, 3)), 0U);
    board.value().pass_time();
  }
  for (const char* const name : {"fired", "host"}) {
    const std::string lines = contents(folder_ + "/fired");
    const std::string host = contents(folder_ + "/host");
    const std::string whole = std::string(name) == "host" ? host : lines;
    for (std::size_t at = 0; at < whole.size(); at += at < 80 ? 1 : 11) {
      if (at >= 12 && at < 16) {
        continue;  // reserved
      }
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
      put(folder_ + "/" + name, damaged);
      const Result<EmulatedBoard> board = open();
      ASSERT_FALSE(board) << name << ", byte " << at;
      EXPECT_EQ(board.error().code, at >= 8 && at < 12 ? ErrorCode::version_mismatch : ErrorCode::bad_file);
      EXPECT_NE(board.error().message.find(folder_ + "/" + name), std::string::npos) << board.error().message;
      if (std::string(name) == "fired") {
        EXPECT_FALSE(fired());
      }
      put(folder_ + "/fired", lines);
      put(folder_ + "/host", host);
    }
  }
}

TEST_F(BoardInAFolder, RefusesAFolderItCannotWrite) {
  put(root_ / "file", "no folder");
  folder_ = (root_ / "file").string();
  const Result<EmulatedBoard> board = open();
  ASSERT_FALSE(board);
  EXPECT_EQ(board.error().code, ErrorCode::io);
}

/// Streams lines for ever, until it is killed.
[[noreturn]] void stream_for_ever(Result<EmulatedBoard> board, const DeviceSetup& setup) {
  for (std::int64_t ordinal = 0;; ++ordinal) {
    std::vector<std::byte> frame;
    test::add_frame(frame, setup, ordinal, static_cast<std::uint32_t>(ordinal));
    std::span<const std::byte> rest = frame;
    while (!rest.empty()) {
      rest = rest.subspan(board.value().take(rest.first(std::min<std::size_t>(rest.size(), 17))));
    }
    if (ordinal % 3 == 0) {
      board.value().pass_time();
    }
  }
}

TEST_F(BoardInAFolder, OutlivesAKilledHost) {
  setup_.end_revolution = 1'000'000;
  gravure::test::Dice dice;
  SCOPED_TRACE(gravure::test::Dice::note());
  for (int trial = 0; trial < 20; ++trial) {
    fs::remove_all(folder_);
    const auto enough = static_cast<std::uintmax_t>(dice.between(20, 20'000));
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      Result<EmulatedBoard> board = open();
      prepare(board.value(), setup_);
      start(board.value());
      stream_for_ever(std::move(board), setup_);
    }
    std::error_code missing;
    for (int wait = 0; wait < 60'000; ++wait) {  // ms
      if (const std::uintmax_t size = fs::file_size(folder_ + "/fired", missing); !missing && size >= enough) {
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ::kill(child, SIGKILL);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    const Result<EmulatedBoard> board = open();
    ASSERT_TRUE(board) << board.error().message;
    const BoardStatus status = board.value().status();
    EXPECT_EQ(status.power_up, 1U);
    EXPECT_EQ(status.fault, DeviceFault::underrun);
    EXPECT_EQ(status.executed_lines, status.taken_lines);
    EXPECT_GT(status.executed_lines, 0U);
    expect_fired(status.executed_lines);
  }
}

}  // namespace
}  // namespace gravure::emulator
