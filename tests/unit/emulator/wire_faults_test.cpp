#include "gravure/emulator/wire_faults.hpp"

#include <gtest/gtest.h>

#include "gravure/emulator/board_name.hpp"
#include "gravure/emulator/emulated_link.hpp"
#include "recorder.hpp"
#include "wire_host.hpp"

namespace gravure::emulator {
namespace {

constexpr auto kPatience = DeviceLink::Milliseconds(0);

TEST(ParseWireFault, ReadsWhatItWrites) {
  for (const char* const text :
       {"underrun@line=3", "silence@line=0+7", "interlock@line=12+19", "power@line=1", "checksum@line=5", "lost@line=5",
        "duplicate@line=0", "shape@line=9223372036854775807", "corrupt@byte=0", "full@byte=77", "stall@byte=1",
        "timeout@byte=1", "disconnect@byte=1", "short@byte=1", "delay@byte=1", "reorder@byte=1"}) {
    const Result<WireFault> fault = parse_wire_fault(text);
    ASSERT_TRUE(fault) << text;
    EXPECT_EQ(to_string(fault.value()), text);
  }
}

TEST(ParseWireFault, RefusesWhatIsNone) {
  for (const char* const text : {"", "underrun", "underrun@", "underrun@line=", "underrun@line=-1", "underrun@byte=1",
                                 "underrun@line=1+", "underrun@line=1+-2", "checksum@line=1+2", "corrupt@line=1",
                                 "corrupt@byte=1 ", "babble@byte=1", "line=1", "lost@line=99999999999999999999"}) {
    const Result<WireFault> fault = parse_wire_fault(text);
    ASSERT_FALSE(fault) << text;
    EXPECT_EQ(fault.error().code, ErrorCode::bad_argument);
    EXPECT_NE(fault.error().message.find("disconnect@byte=N"), std::string::npos);
  }
}

TEST(BoardName, ReadsWhatItWrites) {
  const char* const text =
      "pace=real,capacity=4096,fifo_bits=12,seed=7,seed_hz=1000,serial=B-1,fault=lost@line=2,fault=full@byte=9";
  BoardOptions options;
  ASSERT_TRUE(parse_board_options(text, options));
  EXPECT_EQ(board_options_text(options), text);
  const Result<BoardName> name = parse_board_name(std::string("some/where,") + text);
  ASSERT_TRUE(name);
  EXPECT_EQ(name.value().folder, "some/where");
  EXPECT_EQ(board_options_text(name.value().options), text);
}

TEST(BoardName, RefusesWhatIsNoOption) {
  for (const char* const text : {"", ",seed=1", "d,speed=1", "d,pace=fast", "d,capacity=63", "d,capacity=1k", "d,seed",
                                 "d,fifo_bits=17", "d,serial=", "d,", "d,seed=1,", "d,,seed=1", "d,seed=1,seed=1",
                                 "d,seed=1,fault=lost@line=2,seed=2", "d,serial=a b", "d,seed_hz=0", "d,fault=fire"}) {
    EXPECT_FALSE(parse_board_name(text)) << text;
  }
}

/// A host with twelve lines and a board with a fault.
class Host {
 public:
  explicit Host(const char* fault, std::size_t cut = 50) : cut_(cut) {
    BoardOptions options;
    options.observer = &recorder;
    EXPECT_TRUE(parse_board_options(std::string("fault=") + fault, options));
    board = std::make_shared<EmulatedBoard>(std::move(options));
    link.emplace(board);
  }
  /// Ends with what the link says, or where no byte more is taken.
  Result<void> run() {
    for (const test::Write& one : test::preparation(setup, 100)) {
      GRAVURE_CHECK(link->write_register(one.address, one.value));
    }
    GRAVURE_CHECK(link->write_register(fpga::kControlRegister.address, test::kRunTimed));
    GRAVURE_CHECK(link->write_register(fpga::kCommandRegister.address, test::kGo));
    const std::vector<std::byte> stream = test::wire_stream(setup, 0, 11);
    while (sent < stream.size()) {
      const auto rest = std::span(stream).subspan(sent);
      GRAVURE_TRY(const std::size_t taken, link->send(rest.first(std::min(rest.size(), cut_)), kPatience));
      sent += taken;
      GRAVURE_TRY(const std::optional<BoardStatus> status, link->next_status(kPatience));
      statuses.push_back(status);
      if (taken == 0 || (status && status->state == BoardState::stopped)) {
        break;
      }
    }
    return {};
  }
  /// All that fired is what it should be, line by line from 0 on.
  void expect_fired(std::size_t lines, std::uint32_t slots = 0) const {
    ASSERT_EQ(recorder.lines.size(), lines + (slots != 0 ? 1 : 0));
    for (std::size_t line = 0; line < recorder.lines.size(); ++line) {
      const test::WireLine expected = test::wire_line(setup, static_cast<std::int64_t>(line));
      EXPECT_EQ(recorder.lines[line].ordinal, static_cast<std::int64_t>(line));
      if (line < lines) {
        EXPECT_EQ(recorder.lines[line].fired, expected.bits);
      }
      for (std::uint32_t pixel = 0; line == lines && pixel < 13; ++pixel) {
        const auto bit = static_cast<std::byte>(0x80U >> (pixel % 8));
        EXPECT_EQ((recorder.lines[line].fired[pixel / 8] & bit) != std::byte{0},
                  (expected.bits[pixel / 8] & bit) != std::byte{0} && expected.first_slot + pixel < slots);
      }
    }
  }
  DeviceSetup setup = test::wire_setup();
  test::Recorder recorder;
  std::shared_ptr<EmulatedBoard> board;
  std::optional<EmulatedLink> link;
  std::size_t sent = 0;
  std::vector<std::optional<BoardStatus>> statuses;

 private:
  std::size_t cut_;
};

struct Expected {
  const char* fault;
  DeviceFault named;
  std::uint32_t executed;
  std::uint32_t slot;
};
class FaultOfTheBoard : public testing::TestWithParam<Expected> {};

TEST_P(FaultOfTheBoard, IsNamedAndFiresNothingElse) {
  Host host(GetParam().fault, test::kFrame);  // frame by frame: no line runs when a frame comes
  ASSERT_TRUE(host.run());
  const BoardStatus status = host.board->status();
  EXPECT_EQ(status.fault, GetParam().named);
  EXPECT_EQ(status.executed_lines, GetParam().executed);
  EXPECT_EQ(status.closed_slot, GetParam().slot);
  EXPECT_EQ(status.partial_line, GetParam().slot != 0);
  host.expect_fired(GetParam().executed, GetParam().slot);
}

INSTANTIATE_TEST_SUITE_P(Kinds, FaultOfTheBoard,
                         testing::Values(Expected{"underrun@line=3", DeviceFault::underrun, 3, 0},
                                         Expected{"underrun@line=3+4", DeviceFault::underrun, 3, 4},
                                         Expected{"silence@line=4+9", DeviceFault::host_silence, 4, 9},
                                         Expected{"interlock@line=0+1", DeviceFault::interlock, 0, 1},
                                         Expected{"interlock@line=11+19", DeviceFault::interlock, 11, 19},
                                         Expected{"interlock@line=5+4000", DeviceFault::interlock, 5, 19},
                                         Expected{"checksum@line=6", DeviceFault::checksum, 6, 0},
                                         Expected{"lost@line=6", DeviceFault::underrun, 6, 0},
                                         Expected{"duplicate@line=6", DeviceFault::sequence, 6, 19},
                                         Expected{"shape@line=6", DeviceFault::shape, 6, 0},
                                         Expected{"corrupt@byte=155", DeviceFault::shape, 5, 0},  // the mark of line 5
                                         Expected{"corrupt@byte=180", DeviceFault::checksum, 5, 0}));  // its first bits

TEST(FaultOfTheBoard, LosesAFrameBetweenOthers) {
  Host host("lost@line=6", 12 * test::kFrame);
  ASSERT_TRUE(host.run());
  EXPECT_EQ(host.board->status().fault, DeviceFault::sequence);
  EXPECT_EQ(host.board->status().taken_lines, 6U);
}

TEST(FaultOfTheBoard, TakesNoByteAnyMoreWhereItIsFull) {
  Host host("full@byte=100");
  ASSERT_TRUE(host.run());
  EXPECT_EQ(host.sent, 100U);
  EXPECT_EQ(host.board->status().executed_lines, 100U / test::kFrame);
  const auto more = host.link->send(std::vector<std::byte>(5), DeviceLink::Milliseconds(20));
  ASSERT_TRUE(more);
  EXPECT_EQ(more.value(), 0U);
}

TEST(FaultOfTheBoard, ForgetsAllWhereThePowerGoes) {
  Host host("power@line=3+7", 12 * test::kFrame);
  ASSERT_TRUE(host.run());
  host.expect_fired(3, 7);
  const BoardStatus status = host.board->status();
  EXPECT_EQ(status.power_up, 2U);
  EXPECT_EQ(status.state, BoardState::idle);
  EXPECT_EQ(status.executed_lines, 0U);
  EXPECT_EQ(status.level_bytes, 0U);
}

TEST(FaultOfTheLink, Stalls) {
  Host host("stall@byte=100");
  const Result<void> run = host.run();
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, ErrorCode::device);
  EXPECT_NE(run.error().message.find("stalled at byte 100"), std::string::npos) << run.error().message;
  EXPECT_EQ(host.sent, 100U);
  EXPECT_FALSE(host.link->next_status(kPatience)) << "it goes on failing";
}

TEST(FaultOfTheLink, TimesOut) {
  Host host("timeout@byte=100");
  ASSERT_TRUE(host.run());
  EXPECT_EQ(host.sent, 100U);
  const auto status = host.link->next_status(kPatience);
  ASSERT_TRUE(status);
  EXPECT_FALSE(status.value());
  EXPECT_FALSE(host.link->drain(kPatience).value());
  const auto read = host.link->read_register(0);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::timeout);
}

TEST(FaultOfTheLink, LeavesTheBoardWithoutAHost) {
  Host host("disconnect@byte=100");
  const Result<void> run = host.run();
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, ErrorCode::device);
  EXPECT_NE(run.error().message.find("unplugged"), std::string::npos);
  EXPECT_EQ(host.board->status().fault, DeviceFault::underrun);
  EXPECT_EQ(host.board->status().executed_lines, 3U);
  EmulatedLink again(host.board);
  const auto status = again.next_status(kPatience);
  ASSERT_TRUE(status && status.value());
  EXPECT_EQ(status.value()->executed_lines, 3U);
  host.expect_fired(3);
}

TEST(FaultOfTheLink, CutsATransferShort) {
  Host host("short@byte=77");
  ASSERT_TRUE(host.run());
  EXPECT_EQ(host.sent, 12 * test::kFrame);
  host.expect_fired(12);
}

TEST(FaultOfTheLink, GivesStatusesLate) {
  Host host("delay@byte=100");
  ASSERT_TRUE(host.run());
  host.expect_fired(12);
  EXPECT_TRUE(host.statuses[1]);
  for (const std::size_t late : {2U, 3U, 4U}) {
    EXPECT_FALSE(host.statuses[late]) << late;
  }
  ASSERT_TRUE(host.statuses[5]);
  EXPECT_EQ(host.statuses[5]->executed_lines, 6 * 50 / test::kFrame);
}

TEST(FaultOfTheLink, GivesStatusesInTheWrongOrder) {
  Host host("reorder@byte=100");
  ASSERT_TRUE(host.run());
  EXPECT_FALSE(host.statuses[2]);
  ASSERT_TRUE(host.statuses.back());
  const auto old = host.link->next_status(kPatience);
  ASSERT_TRUE(old && old.value());
  EXPECT_LT(old.value()->sequence, host.statuses.back()->sequence);
  EXPECT_LT(old.value()->executed_lines, 12U);
}

}  // namespace
}  // namespace gravure::emulator
