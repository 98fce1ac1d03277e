#include "gravure/emulator/schedule.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "gravure/fpga/synchro.hpp"
#include "recorder.hpp"

namespace gravure::emulator {
namespace {

/// Clocks of the whole board's model at which a pin of axis 0 changes, from the write of `go` on.
class BoardAxis {
 public:
  void write(const fpga::Register& target, std::uint64_t value) {
    for (int word = 0; word < (target.bits > 32 ? 2 : 1); ++word) {
      fpga::Synchro::Inputs in;
      in.write = true;
      in.address = static_cast<std::uint8_t>(target.address + word);
      in.write_data = static_cast<std::uint32_t>(value >> static_cast<unsigned>(32 * word));
      hold(in, 2);
    }
  }
  void hold(const fpga::Synchro::Inputs& in, std::uint64_t clocks) {
    for (; clocks > 0; --clocks) {
      const fpga::Synchro::Outputs out = board_.step(in);
      ++clock_;
      EXPECT_FALSE(out.a != was_.a && out.b != was_.b) << "both pins at once on clock " << clock_;
      if (out.a != was_.a || out.b != was_.b) {
        edges.push_back(clock_);
      }
      was_ = out;
    }
  }
  std::vector<std::uint64_t> edges;

 private:
  fpga::Synchro board_{6};
  fpga::Synchro::Outputs was_;
  std::uint64_t clock_ = 0;
};

/// The board, its registers loaded at rest, the schedule appended, and go; then `after` more clocks.
std::vector<std::uint64_t> board_edges(const fpga::AbRegisters& registers, const std::vector<ScheduleSegment>& schedule,
                                       std::uint64_t clocks) {
  BoardAxis board;
  fpga::Synchro::Inputs reset;
  reset.rst = true;
  board.hold(reset, 8);
  board.write(fpga::kIncrementRegister, 0);
  board.write(fpga::kPrescalerRegister, registers.prescaler);
  board.write(fpga::kFractionNumRegister, registers.fraction_num);
  board.write(fpga::kFractionDenRegister, registers.fraction_den);
  board.write(fpga::kControlRegister, 2);  // enable axis 0
  board.write(fpga::kCommandRegister, 2);  // load it
  board.hold({}, 60);
  for (const ScheduleSegment& segment : schedule) {
    board.write(fpga::kScheduleIncrementRegister, segment.increment);
    board.write(fpga::kScheduleSeedsRegister, segment.seeds);
    board.write(fpga::kCommandRegister, 128);  // append to schedule 0
  }
  board.write(fpga::kCommandRegister, 64);  // go
  board.hold({}, clocks);
  return board.edges;
}

/// The same by the rule of the counter: a step on every clock where (clock + phase) is a multiple of the prescaler,
/// after `waiting` steps at rest that the fraction gathers in. The last increment stays in force.
std::vector<std::uint64_t> ruled_edges(const fpga::AbRegisters& registers, const std::vector<ScheduleSegment>& schedule,
                                       std::uint64_t clocks, std::uint64_t phase, std::uint64_t waiting) {
  std::vector<std::uint64_t> edges;
  fpga::Uint128 counts = waiting * registers.fraction_num / registers.fraction_den;
  std::uint64_t accumulator = waiting * registers.fraction_num % registers.fraction_den;
  std::size_t at = 0;
  std::uint64_t left = 2 * schedule[0].seeds;
  for (std::uint64_t clock = 1; clock <= clocks; ++clock) {
    if (left == 0 && at + 1 < schedule.size()) {
      left = 2 * schedule[++at].seeds;
    }
    left -= left > 0 ? 1 : 0;
    if ((clock + phase) % registers.prescaler != 0) {
      continue;
    }
    accumulator += registers.fraction_num;
    const bool carry = accumulator >= registers.fraction_den;
    accumulator -= carry ? registers.fraction_den : 0;
    const auto before = static_cast<std::uint64_t>(counts >> 30U);
    counts += schedule[at].increment + (carry ? 1U : 0U);
    if (static_cast<std::uint64_t>(counts >> 30U) != before) {
      edges.push_back(clock);
    }
  }
  return edges;
}

/// All that is ruled comes on the board, later by the same all over.
bool same_but_for_latency(const std::vector<std::uint64_t>& board, const std::vector<std::uint64_t>& ruled) {
  if (board.size() < ruled.size()) {
    return false;
  }
  for (std::size_t i = 0; i < ruled.size(); ++i) {
    if (board[i] - ruled[i] != board[0] - ruled[0]) {
      return false;
    }
  }
  return true;
}

/// Stairs that rise to the increment of marking, which the last one has.
std::vector<ScheduleSegment> random_stairs(std::mt19937_64& rng, const fpga::AbRegisters& registers) {
  std::vector<ScheduleSegment> schedule;
  const std::uint64_t count = 2 + rng() % 20;
  for (std::uint64_t i = 1; i <= count; ++i) {
    schedule.push_back({registers.increment / count * i, registers.prescaler * (1 + rng() % 40)});
  }
  schedule.back().increment = registers.increment;
  return schedule;
}

fpga::AbRegisters random_registers(std::mt19937_64& rng, bool fraction) {
  fpga::AbRegisters registers{.bits = 32, .prescaler = 1 + rng() % 3, .increment = 0};
  registers.increment = (std::uint64_t{1} << 28U) + rng() % (std::uint64_t{1} << 29U);
  if (fraction) {
    registers.prescaler = 1;
    registers.fraction_den = 2 + rng() % 1000;
    registers.fraction_num = rng() % registers.fraction_den;
  }
  return registers;
}

TEST(Schedule, RunsOnTheBoardWithoutAGapIntoTheMarking) {
  std::mt19937_64 rng(3);
  for (int trial = 0; trial < 60; ++trial) {
    const fpga::AbRegisters registers = random_registers(rng, trial % 3 == 0);
    const std::vector<ScheduleSegment> schedule = random_stairs(rng, registers);
    const std::vector<std::uint64_t> board = board_edges(registers, schedule, 8100);
    ASSERT_GT(board.size(), 500U);
    bool found = false;
    const std::uint64_t most_waiting = registers.fraction_num != 0 ? 600 : 1;
    for (std::uint64_t phase = 0; phase < registers.prescaler && !found; ++phase) {
      for (std::uint64_t waiting = 0; waiting < most_waiting && !found; ++waiting) {
        found = same_but_for_latency(board, ruled_edges(registers, schedule, 8000, phase, waiting));
      }
    }
    ASSERT_TRUE(found) << "trial " << trial << ": an edge of the board comes at another time";
  }
}

TEST(Schedule, LeavesTheEmulatedAxisWhereTheRuleDoesAtTickZeroAndLater) {
  std::mt19937_64 rng(4);
  for (int trial = 0; trial < 200; ++trial) {
    const fpga::AbRegisters registers = random_registers(rng, trial % 2 == 0);
    const std::vector<ScheduleSegment> schedule = random_stairs(rng, registers);
    std::uint64_t ticks = 0;
    for (const ScheduleSegment& segment : schedule) {
      ticks += 2 * segment.seeds;
    }
    const ScheduleEnd end = run_schedule(schedule, registers, 2);
    const auto before = static_cast<std::int64_t>(ruled_edges(registers, schedule, ticks, 0, 0).size());
    ASSERT_EQ(state_of(end, registers).edges, before);
    for (const std::uint64_t later : {std::uint64_t{0}, 1 + rng() % 10, rng() % 5000}) {
      ASSERT_EQ(axis_after(end, registers, static_cast<std::int64_t>(later)).edges + before,
                static_cast<std::int64_t>(ruled_edges(registers, schedule, ticks + later, 0, 0).size()))
          << "trial " << trial << ", tick " << later;
    }
  }
}

TEST(Schedule, IsRefusedWhereTheBoardCouldNotRunIt) {
  DeviceSetup good = test::small_setup();
  good.clock_multiplier = 2;
  good.ticks_per_slot = 2;
  good.prescaler = 4;
  good.spin_up = {{10, 2}, {20, 4}};
  const auto refuses = [&](const auto& change, const std::string& part) {
    DeviceSetup setup = good;
    change(setup);
    EmulatedDevice device;
    const Result<void> configured = device.configure(setup);
    ASSERT_FALSE(configured) << part;
    EXPECT_EQ(configured.error().code, ErrorCode::device);
    EXPECT_NE(configured.error().message.find(part), std::string::npos) << configured.error().message;
  };
  EmulatedDevice device;
  ASSERT_TRUE(device.configure(good)) << device.configure(good).error().message;
  refuses([](DeviceSetup& s) { s.spin_up[0].seeds = 0; }, "spin_up seeds = 0");
  refuses([](DeviceSetup& s) { s.spin_up[0].seeds = std::uint64_t{1} << 32U; }, "allowed is 1 to 4294967295");
  refuses([](DeviceSetup& s) { s.spin_up[1].seeds = 3; }, "whole steps of the prescaler, 4 ticks");
  refuses([](DeviceSetup& s) { s.spin_up[0].increment = ~std::uint64_t{0}; }, "spin_up increment");
  refuses([](DeviceSetup& s) { s.spin_up.assign(257, {10, 2}); }, "257 segments: its list holds 256");
  refuses([](DeviceSetup& s) { s.spin_up.assign(2, {10, 4'294'967'294}); }, "first_tick counts to 4294967295");
  refuses([](DeviceSetup& s) { s.carriage.spin_up = {{1, 0}}; }, "carriage.spin_up seeds = 0");
}

}  // namespace
}  // namespace gravure::emulator
