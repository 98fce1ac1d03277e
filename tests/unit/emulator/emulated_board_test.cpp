#include "gravure/emulator/emulated_board.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "gravure/emulator/emulated_link.hpp"
#include "gravure/emulator/schedule.hpp"
#include "recorder.hpp"
#include "wire_host.hpp"

namespace gravure::emulator {
namespace {

using test::add_frame;
using test::kGo;
using test::kRunTimed;
using test::Recorder;
using test::wire_line;
using test::wire_setup;
using test::wire_stream;

class Board : public testing::Test {
 protected:
  explicit Board(BoardOptions options = {})
      : board_([this, &options] {
          options.observer = &recorder_;
          return options;
        }()) {}
  void write(const fpga::Register& target, std::uint32_t value) { board_.write_register(target.address, value); }
  std::uint32_t read(const fpga::Register& target) { return board_.read_register(target.address); }
  void prepare(const DeviceSetup& setup, std::uint32_t first_tick = 100) {
    for (const test::Write& one : test::preparation(setup, first_tick)) {
      board_.write_register(one.address, one.value);
    }
  }
  void start() {
    write(fpga::kControlRegister, kRunTimed);
    write(fpga::kCommandRegister, kGo);
  }
  void expect_lines(const DeviceSetup& setup, std::int64_t count) {
    ASSERT_EQ(recorder_.lines.size(), static_cast<std::size_t>(count));
    for (std::int64_t ordinal = 0; ordinal < count; ++ordinal) {
      const Recorder::Line& line = recorder_.lines[static_cast<std::size_t>(ordinal)];
      const test::WireLine expected = wire_line(setup, ordinal);
      EXPECT_EQ(line.ordinal, ordinal);
      EXPECT_EQ(line.first_slot, expected.first_slot);
      EXPECT_EQ(line.fired, expected.bits) << "line " << ordinal;
    }
  }
  Recorder recorder_;
  EmulatedBoard board_;
};

TEST_F(Board, SaysWhatItIs) {
  EXPECT_EQ(read(fpga::kMagicRegister), fpga::kMagicRegister.reset);
  EXPECT_EQ(read(fpga::kVersionRegister), fpga::kVersionRegister.reset);
  EXPECT_EQ(read(fpga::kFifoBitsRegister), 16U);
  EXPECT_EQ(board_.read_register(0x85), 0x04020010U) << "the descriptor of the line FIFO";
  EXPECT_EQ(board_.read_register(0x8b), fpga::kDescriptors[11]);
  EXPECT_EQ(board_.status().state, BoardState::idle);
  EXPECT_EQ(board_.status().capacity_bytes, 1U << 20U);
}

TEST_F(Board, KeepsWhatARegisterTakesAndRefusesTheRest) {
  for (const fpga::Register& one : fpga::kRegisters) {
    if (one.access != fpga::RegisterAccess::read_write) {
      continue;
    }
    write(fpga::kCommandRegister, test::kAcknowledge);
    const std::uint64_t most = fpga::largest(one) - (one.name == "control" ? 1 : 0);  // not to run slots
    board_.write_register(one.address, static_cast<std::uint32_t>(most));
    EXPECT_EQ(read(one), static_cast<std::uint32_t>(most)) << one.name;
    EXPECT_EQ(read(fpga::kStatusRegister) & 0x800U, 0U) << one.name;
    if (one.bits < 32) {
      board_.write_register(one.address, static_cast<std::uint32_t>(fpga::largest(one) + 1));
      EXPECT_EQ(read(one), static_cast<std::uint32_t>(most)) << one.name;
      EXPECT_NE(read(fpga::kStatusRegister) & 0x800U, 0U) << one.name;
    }
  }
}

TEST_F(Board, RunsTheLinesOfAJob) {
  const DeviceSetup setup = wire_setup();
  prepare(setup);
  EXPECT_EQ(board_.status().state, BoardState::filling);
  const std::vector<std::byte> stream = wire_stream(setup, 0, 11);
  EXPECT_EQ(board_.take(stream), stream.size());
  EXPECT_EQ(board_.status().taken_lines, 12U);
  EXPECT_EQ(board_.status().level_bytes, stream.size());
  board_.pass_time();
  EXPECT_EQ(board_.status().executed_lines, 0U) << "nobody said go";
  start();
  board_.pass_time();
  const BoardStatus status = board_.status();
  EXPECT_EQ(status.state, BoardState::running);
  EXPECT_EQ(status.executed_lines, 12U);
  EXPECT_EQ(status.revolution, 3U);
  EXPECT_EQ(status.line, 0U);
  EXPECT_EQ(status.level_bytes, 0U);
  EXPECT_EQ(status.tick, (100U + 12 * 40) * 2);
  EXPECT_EQ(status.fault, DeviceFault::none);
  expect_lines(setup, 12);
  for (std::int64_t line = 0; line < 12; ++line) {
    EXPECT_EQ(recorder_.lines[static_cast<std::size_t>(line)].start_tick, (100 + line * 40) * 2);
  }
  write(fpga::kControlRegister, 0);
  EXPECT_EQ(board_.status().state, BoardState::idle);
}

TEST_F(Board, TurnsTheAxesAsTheirCountersDo) {
  DeviceSetup setup = wire_setup();
  setup.carriage.increment = 3'000'000;
  prepare(setup, 50);
  ASSERT_NE(board_.take(wire_stream(setup, 0, 11)), 0U);
  start();
  board_.pass_time();
  ASSERT_EQ(recorder_.lines.size(), 12U);
  const fpga::AbRegisters registers{.bits = 32,
                                    .prescaler = setup.prescaler,
                                    .increment = setup.increment,
                                    .fraction_num = setup.fraction_num,
                                    .fraction_den = setup.fraction_den};
  for (const Recorder::Line& line : recorder_.lines) {
    const fpga::AbPosition expected = fpga::position_after(registers, static_cast<std::uint64_t>(line.start_tick));
    EXPECT_EQ(line.axis.edges, expected.edges);
    EXPECT_EQ(line.axis.counts_low, static_cast<std::uint64_t>(expected.counts));
    EXPECT_EQ(line.carriage.counts_low, 3'000'000U * static_cast<std::uint64_t>(line.start_tick));
  }
}

TEST_F(Board, SpinsItsAxisUpBySchedule) {
  const DeviceSetup setup = wire_setup();
  prepare(setup, 300);
  const std::vector<ScheduleSegment> segments{{1'000'000, 100}, {5'000'000, 150}, {9'000'000, 50}};
  for (const ScheduleSegment& segment : segments) {
    write(fpga::kScheduleIncrementRegister, static_cast<std::uint32_t>(segment.increment));
    write(fpga::kScheduleSeedsRegister, static_cast<std::uint32_t>(segment.seeds));
    write(fpga::kCommandRegister, 128);
  }
  ASSERT_NE(board_.take(wire_stream(setup, 0, 1)), 0U);
  start();
  EXPECT_NE(read(fpga::kStatusRegister) & 0x100U, 0U) << "busy";
  board_.pass_time();
  ASSERT_EQ(recorder_.lines.size(), 2U);
  const fpga::AbRegisters registers{.bits = 32,
                                    .prescaler = setup.prescaler,
                                    .increment = 9'000'000,
                                    .fraction_num = setup.fraction_num,
                                    .fraction_den = setup.fraction_den};
  const ScheduleEnd end = run_schedule(segments, registers, 2);
  EXPECT_EQ(recorder_.lines[0].axis.counts_low, static_cast<std::uint64_t>(end.counts));
  const AxisState after = axis_after(end, registers, 80);
  EXPECT_EQ(recorder_.lines[1].axis.counts_low, static_cast<std::uint64_t>(end.counts) + after.counts_low);
}

TEST_F(Board, TakesAnyCutsOfTheStream) {
  const DeviceSetup setup = wire_setup();
  prepare(setup);
  start();
  const std::vector<std::byte> stream = wire_stream(setup, 0, 11);
  for (std::size_t at = 0; at < stream.size(); at += 7) {
    const auto part = std::span(stream).subspan(at).first(std::min<std::size_t>(7, stream.size() - at));
    ASSERT_EQ(board_.take(part), part.size());
    board_.pass_time();
    EXPECT_EQ(board_.status().executed_lines, (at + part.size()) / test::kFrame);
  }
  expect_lines(setup, 12);
}

/// What is wrong with a frame, and the fault it brings.
struct Wrong {
  std::size_t byte;
  std::byte mask;
  DeviceFault fault;
};
class BadFrame : public Board, public testing::WithParamInterface<Wrong> {};

TEST_P(BadFrame, ClosesTheGateInALineBeforeIt) {
  const DeviceSetup setup = wire_setup();
  prepare(setup);
  start();
  std::vector<std::byte> stream = wire_stream(setup, 0, 7);
  stream[5 * test::kFrame + GetParam().byte] ^= GetParam().mask;
  ASSERT_EQ(board_.take(stream), stream.size());
  board_.pass_time();
  const BoardStatus status = board_.status();
  EXPECT_EQ(status.state, BoardState::stopped);
  EXPECT_EQ(status.fault, GetParam().fault);
  EXPECT_EQ(status.faults, (1U << (static_cast<unsigned>(GetParam().fault) - 1U)) | 8U) << "then the lines run out";
  EXPECT_EQ(status.taken_lines, 5U);
  EXPECT_LT(status.executed_lines, 5U);
  EXPECT_EQ(read(fpga::kStatusRegister) & 15U, 8U | static_cast<unsigned>(status.fault));
  // Exactly the slots before it fired.
  ASSERT_EQ(recorder_.lines.size(), status.executed_lines + (status.partial_line ? 1U : 0U));
  if (status.partial_line) {
    const test::WireLine whole = wire_line(setup, status.executed_lines);
    const std::vector<std::byte>& fired = recorder_.lines.back().fired;
    for (std::uint32_t pixel = 0; pixel < 13; ++pixel) {
      const auto bit = static_cast<std::byte>(0x80U >> (pixel % 8));
      const bool expected =
          (whole.bits[pixel / 8] & bit) != std::byte{0} && whole.first_slot + pixel < status.closed_slot;
      EXPECT_EQ((fired[pixel / 8] & bit) != std::byte{0}, expected) << "pixel " << pixel;
    }
    recorder_.lines.pop_back();
  }
  expect_lines(setup, status.executed_lines);
}

TEST_P(BadFrame, IsOverAfterAnAcknowledgeAndANewPosition) {
  const DeviceSetup setup = wire_setup();
  prepare(setup);
  std::vector<std::byte> stream = wire_stream(setup, 0, 7);
  stream[GetParam().byte] ^= GetParam().mask;
  ASSERT_EQ(board_.take(stream), stream.size());
  EXPECT_EQ(board_.status().fault, GetParam().fault);
  EXPECT_EQ(board_.status().faults, 1U << (static_cast<unsigned>(GetParam().fault) - 1U));
  prepare(setup);
  EXPECT_EQ(board_.status().fault, DeviceFault::none);
  EXPECT_EQ(board_.status().level_bytes, 0U);
  start();
  ASSERT_NE(board_.take(wire_stream(setup, 0, 7)), 0U);
  board_.pass_time();
  expect_lines(setup, 8);
}

INSTANTIATE_TEST_SUITE_P(
    Fields, BadFrame,
    testing::Values(Wrong{0, std::byte{1}, DeviceFault::shape}, Wrong{1, std::byte{1}, DeviceFault::shape},
                    Wrong{4, std::byte{2}, DeviceFault::shape}, Wrong{5, std::byte{1}, DeviceFault::sequence},
                    Wrong{9, std::byte{1}, DeviceFault::sequence}, Wrong{16, std::byte{0x80}, DeviceFault::sequence},
                    Wrong{17, std::byte{8}, DeviceFault::shape}, Wrong{20, std::byte{1}, DeviceFault::shape},
                    Wrong{21, std::byte{1}, DeviceFault::shape}, Wrong{26, std::byte{1}, DeviceFault::shape},
                    Wrong{25, std::byte{1}, DeviceFault::checksum}, Wrong{30, std::byte{0x40}, DeviceFault::checksum}));

TEST_F(Board, HoldsNoMoreThanItsCapacity) {
  board_ = EmulatedBoard({.capacity_bytes = 5 * test::kFrame + 3, .observer = &recorder_});
  const DeviceSetup setup = wire_setup();
  prepare(setup);
  const std::vector<std::byte> stream = wire_stream(setup, 0, 11);
  EXPECT_EQ(board_.take(stream), 5 * test::kFrame + 3);
  EXPECT_EQ(board_.take(std::span(stream).subspan(5 * test::kFrame + 3)), 0U);
  start();
  board_.pass_time();
  EXPECT_EQ(board_.status().executed_lines, 5U);
  EXPECT_EQ(board_.status().level_bytes, 3U);
  EXPECT_EQ(board_.take(std::span(stream).subspan(5 * test::kFrame + 3)), 5 * test::kFrame);
  board_.pass_time();
  expect_lines(setup, 10);
}

TEST_F(Board, RefusesALineThatItsFifoNeverHolds) {
  board_ = EmulatedBoard({.fifo_bits = 4, .observer = &recorder_});
  DeviceSetup setup = wire_setup();
  setup.slots_per_line = 200;
  setup.window_slots = 129;
  prepare(setup);
  start();
  ASSERT_NE(board_.take(wire_stream(setup, 0, 1)), 0U);
  EXPECT_EQ(board_.status().fault, DeviceFault::shape);
  EXPECT_NE(read(fpga::kStatusRegister) & 0x40U, 0U);
}

TEST_F(Board, LosesAllWithItsPower) {
  const DeviceSetup setup = wire_setup();
  prepare(setup);
  ASSERT_NE(board_.take(wire_stream(setup, 0, 11)), 0U);
  board_.power_cycle();
  const BoardStatus status = board_.status();
  EXPECT_EQ(status.power_up, 2U);
  EXPECT_EQ(status.state, BoardState::idle);
  EXPECT_EQ(status.level_bytes, 0U);
  EXPECT_EQ(read(fpga::kSlotsPerLineRegister), 0U);
}

/// A clock that runs freely, by hand: 10 seed clocks a microsecond.
class FreeBoard : public Board {
 protected:
  FreeBoard() {
    board_ = EmulatedBoard({.seed_hz = 10'000'000, .now_ns = [this] { return now_ns_; }, .observer = &recorder_});
  }
  void at_seed(std::uint64_t seed) { now_ns_ = seed * 100; }
  std::uint64_t now_ns_ = 0;
};

TEST_F(FreeBoard, RunsLinesAsTheirTimeComes) {
  const DeviceSetup setup = wire_setup();
  prepare(setup);
  ASSERT_NE(board_.take(wire_stream(setup, 0, 11)), 0U);
  start();
  const auto executed_at = [&](std::uint64_t seed) {
    at_seed(seed);
    board_.pass_time();
    return board_.status().executed_lines;
  };
  EXPECT_EQ(executed_at(99), 0U);
  EXPECT_EQ(board_.status().state, BoardState::filling);
  EXPECT_EQ(executed_at(139), 0U);
  EXPECT_EQ(board_.status().state, BoardState::running);
  EXPECT_EQ(executed_at(140), 1U);
  EXPECT_EQ(executed_at(219), 2U);
  EXPECT_EQ(executed_at(580), 12U);
  EXPECT_EQ(board_.status().fault, DeviceFault::underrun) << "the machine does not wait";
  EXPECT_FALSE(board_.status().partial_line);
  expect_lines(setup, 12);
}

TEST_F(FreeBoard, ClosesTheGateInTheSlotAnInterlockOpens) {
  const DeviceSetup setup = wire_setup();
  prepare(setup);
  ASSERT_NE(board_.take(wire_stream(setup, 0, 11)), 0U);
  start();
  at_seed(100 + 3 * 40 + 15);
  board_.open_interlock();
  const BoardStatus status = board_.status();
  EXPECT_EQ(status.fault, DeviceFault::interlock);
  EXPECT_EQ(status.faults, 32U);
  EXPECT_EQ(status.executed_lines, 3U);
  EXPECT_TRUE(status.partial_line);
  EXPECT_EQ(status.closed_slot, 8U) << "seven and a half have passed, the eighth has begun";
  at_seed(100 + 12 * 40);
  board_.pass_time();
  EXPECT_EQ(board_.status().faults, 32U | 8U);
  EXPECT_EQ(board_.status().executed_lines, 3U);
}

TEST_F(FreeBoard, ClosesTheGateWhenTheHostIsSilent) {
  const DeviceSetup setup = wire_setup();
  prepare(setup);
  write(fpga::kSilenceLimitRegister, 250);
  ASSERT_NE(board_.take(wire_stream(setup, 0, 11)), 0U);
  write(fpga::kControlRegister, kRunTimed | test::kWatch);
  write(fpga::kCommandRegister, kGo);
  at_seed(200);
  ASSERT_EQ(board_.take(std::vector<std::byte>{std::byte{0xA5}}), 1U);
  at_seed(449);
  board_.pass_time();
  EXPECT_EQ(board_.status().fault, DeviceFault::none);
  at_seed(1000);
  board_.pass_time();
  const BoardStatus status = board_.status();
  EXPECT_EQ(status.fault, DeviceFault::host_silence);
  EXPECT_EQ(status.executed_lines, 8U) << "200 + 250 is in line 8";
  EXPECT_EQ(status.closed_slot, 15U);
}

TEST_F(FreeBoard, CutsTheLineThatAStopMeets) {
  const DeviceSetup setup = wire_setup();
  prepare(setup);
  ASSERT_NE(board_.take(wire_stream(setup, 0, 11)), 0U);
  start();
  at_seed(100 + 40 + 7);
  write(fpga::kControlRegister, 0);
  const BoardStatus status = board_.status();
  EXPECT_EQ(status.state, BoardState::idle);
  EXPECT_EQ(status.fault, DeviceFault::none);
  EXPECT_EQ(status.executed_lines, 1U);
  EXPECT_EQ(status.closed_slot, 4U);
  at_seed(100000);
  board_.pass_time();
  EXPECT_EQ(recorder_.lines.size(), 2U);
}

TEST(EmulatedLink, GivesEveryStatusOnce) {
  EmulatedLink link{EmulatedBoard({.serial = "B7"})};
  EXPECT_EQ(link.identity().serial, "B7");
  const auto patience = DeviceLink::Milliseconds(50);
  const auto first = link.next_status(patience);
  ASSERT_TRUE(first && first.value());
  EXPECT_EQ(first.value()->sequence, 0U);
  const auto none = link.next_status(patience);
  ASSERT_TRUE(none);
  EXPECT_FALSE(none.value());
  ASSERT_TRUE(link.write_register(fpga::kCommandRegister.address, test::kPosition));
  const auto second = link.next_status(patience);
  ASSERT_TRUE(second && second.value());
  EXPECT_EQ(second.value()->sequence, 1U);
  EXPECT_EQ(second.value()->state, BoardState::filling);
}

TEST(EmulatedLink, SendsAJobLargerThanTheBoard) {
  EmulatedLink link{EmulatedBoard({.capacity_bytes = 2 * test::kFrame})};
  const DeviceSetup setup = wire_setup();
  for (const test::Write& one : test::preparation(setup, 100)) {
    ASSERT_TRUE(link.write_register(one.address, one.value));
  }
  ASSERT_TRUE(link.write_register(fpga::kControlRegister.address, kRunTimed));
  ASSERT_TRUE(link.write_register(fpga::kCommandRegister.address, kGo));
  const std::vector<std::byte> stream = wire_stream(setup, 0, 11);
  std::size_t at = 0;
  while (at < stream.size()) {
    const auto sent = link.send(std::span(stream).subspan(at), DeviceLink::Milliseconds(1000));
    ASSERT_TRUE(sent);
    ASSERT_NE(sent.value(), 0U);
    at += sent.value();
  }
  const auto status = link.next_status(DeviceLink::Milliseconds(0));
  ASSERT_TRUE(status && status.value());
  EXPECT_EQ(status.value()->executed_lines, 12U);
}

}  // namespace
}  // namespace gravure::emulator
