#include "gravure/protocol/start_sequence.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "dice.hpp"
#include "gravure/emulator/schedule.hpp"
#include "gravure/fpga/register_map.hpp"
#include "gravure/fpga/synchro_events.hpp"
#include "gravure/protocol/frame.hpp"

namespace gravure::protocol {
namespace {

using gravure::test::Dice;

constexpr int kFifoBits = 12;
constexpr std::uint64_t kSeedClock = fpga::AbGenerator::kClockMultiplier;
/// FPGA clocks from the end of the write of go to where the gate shows tick 0 of a line at first_tick = 0. A write is
/// taken on the first of its two clocks.
constexpr std::uint64_t kGoToGate =
    kSeedClock * (fpga::kSettingsLatency - 1 + fpga::kStartLatency + fpga::kSlotToGate) - 1;

/// 3 revolutions of 4 lines of 120 slots of 2 seed clocks, 13 of them in the window.
DeviceSetup small_setup() {
  DeviceSetup setup;
  setup.prescaler = 3;
  setup.increment = 700'000'001;
  setup.fraction_num = 5;
  setup.fraction_den = 7;
  setup.carriage = {.prescaler = 2, .increment = 123'456'789};
  setup.clock_multiplier = 2;
  setup.ticks_per_slot = 4;
  setup.slots_per_line = 120;
  setup.window_slots = 13;
  setup.lines_per_revolution = 4;
  setup.end_revolution = 3;
  return setup;
}

std::uint16_t bits_of(std::int64_t ordinal) {
  return static_cast<std::uint16_t>((0x8001U + 0x1111U * static_cast<unsigned>(ordinal)) & 0xFFF8U);
}

/// The model of the whole board, with the writes and frames of a host on its wires.
class Board {
 public:
  void write(const std::vector<RegisterWrite>& writes) {
    for (const RegisterWrite& one : writes) {
      fpga::Synchro::Inputs in;
      in.write = true;
      in.address = one.address;
      in.write_data = one.value;
      hold(in, 1);
      go_ = events_.clock();
      hold({}, 20);
    }
  }
  std::uint32_t read(const fpga::Register& source) {
    fpga::Synchro::Inputs in;
    in.address = source.address;
    hold(in, 4);
    return events_.outputs().read_data;
  }
  /// Lines first .. end over the job, whole.
  void stream(const DeviceSetup& setup, const LineTiming& timing, std::int64_t end) {
    const std::int64_t first = setup.first_revolution * setup.lines_per_revolution + setup.first_line;
    for (std::int64_t line = first; line < end; ++line) {
      const std::uint16_t word = bits_of(line);
      const std::array<std::byte, 2> bits{static_cast<std::byte>(word >> 8U), static_cast<std::byte>(word)};
      const Result<std::int64_t> slot = framed_first_slot(3 + line, (line & 1) != 0, timing);
      ASSERT_TRUE(slot);
      std::vector<std::byte> frame;
      append_frame(frame,
                   {.sequence = static_cast<std::uint32_t>(line - first),
                    .revolution = static_cast<std::uint32_t>(line / setup.lines_per_revolution),
                    .line = static_cast<std::uint32_t>(line % setup.lines_per_revolution),
                    .first_slot = static_cast<std::uint32_t>(slot.value())},
                   bits);
      for (const std::byte byte : frame) {
        fpga::Synchro::Inputs in;
        in.in_valid = true;
        in.in_data = std::to_integer<std::uint8_t>(byte);
        hold(in, 1);
      }
    }
    hold({}, 20);
  }
  void hold(const fpga::Synchro::Inputs& in, std::uint64_t seed_clocks) {
    events_.run(in, seed_clocks * kSeedClock, [this](const fpga::SynchroEvents::Event& now) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        edges_[axis] += now.axes[axis] == before_.axes[axis] ? 0 : 1;
      }
      if (now.axes[0] != before_.axes[0]) {
        moves_.emplace_back(now.clock, edges_[0]);
      }
      if (now.gate != before_.gate) {
        gate_.emplace_back(now.clock, now.gate);
      }
      fault_ = now.fault;
      before_ = now;
    });
  }
  /// Clocks after go at which the gate let a slot through, in slots of 4 ticks since the first line began.
  std::vector<std::uint64_t> fired_slots(std::uint64_t first_tick) const {
    std::vector<std::uint64_t> slots;
    const std::uint64_t zero = go_ + kGoToGate + first_tick * kSeedClock;
    for (std::size_t at = 0; at + 1 < gate_.size(); ++at) {
      if (gate_[at].second) {
        EXPECT_EQ((gate_[at].first - zero) % 4, 0U);
        for (std::uint64_t clock = gate_[at].first; clock < gate_[at + 1].first; clock += 4) {
          slots.push_back((clock - zero) / 4);
        }
      }
    }
    return slots;
  }
  /// Edges of axis 0 after so many clocks since go.
  std::uint64_t edges_at(std::uint64_t since_go) const {
    std::uint64_t edges = 0;
    for (const auto& [clock, count] : moves_) {
      edges = clock <= go_ + since_go ? count : edges;
    }
    return edges;
  }
  std::uint64_t edges(std::size_t axis) const { return edges_[axis]; }
  std::uint8_t fault() const { return fault_; }
  void forget() {
    gate_.clear();
    moves_.clear();
    edges_ = {};
  }

 private:
  fpga::SynchroEvents events_{kFifoBits};
  fpga::SynchroEvents::Event before_;
  std::vector<std::pair<std::uint64_t, bool>> gate_;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> moves_;
  std::array<std::uint64_t, 2> edges_{};
  std::uint64_t go_ = 0;
  std::uint8_t fault_ = 0;
};

/// Runs lines first .. end and holds the gate against their bits.
StartSequence expect_runs(Board& board, DeviceSetup setup, LineTiming timing, std::int64_t first, std::int64_t end) {
  setup.first_revolution = first / setup.lines_per_revolution;
  setup.first_line = first % setup.lines_per_revolution;
  timing.lines_before = static_cast<std::uint64_t>(setup.first_line);
  setup.end_revolution = (end + setup.lines_per_revolution - 1) / setup.lines_per_revolution;
  const Result<StartSequence> sequence = start_sequence(setup, timing);
  EXPECT_TRUE(sequence) << sequence.error().message;
  constexpr std::uint32_t kRefused =
      kStatusSettingRefused | kStatusLoad0Refused | kStatusLoad1Refused | kStatusScheduleOverflow;
  board.write(sequence.value().settings);
  EXPECT_EQ(board.read(fpga::kStatusRegister) & kRefused, 0U);
  board.write(sequence.value().prepare);
  EXPECT_EQ(board.read(fpga::kStatusRegister) & kRefused, 0U);
  board.forget();
  board.stream(setup, timing, end);
  EXPECT_EQ(board.edges(0), 0U) << "the axes stand until go";
  board.write(sequence.value().start);
  EXPECT_EQ(board.read(fpga::kStatusRegister) & kStatusSettingRefused, 0U);
  board.hold({}, sequence.value().first_tick + static_cast<std::uint64_t>(end - first) * 240 - 60);
  EXPECT_EQ(board.fault(), 0);
  std::vector<std::uint64_t> wanted;
  for (std::int64_t line = first; line < end; ++line) {
    for (std::int64_t slot = 0; slot < 13; ++slot) {
      if ((bits_of(line) >> (15 - slot) & 1U) != 0) {
        wanted.push_back(static_cast<std::uint64_t>((line - first) * 120 + 3 + line + slot));
      }
    }
  }
  EXPECT_EQ(board.fired_slots(sequence.value().first_tick), wanted);
  return sequence.value();
}

TEST(StartSequence, MakesTheBoardRunTheLines) {
  Board board;
  const StartSequence sequence = expect_runs(board, small_setup(), {.slots_per_microvector = 5}, 0, 12);
  EXPECT_EQ(sequence.first_tick, kStartLead);
  EXPECT_GT(board.edges(0), 1000U);
  EXPECT_GT(board.edges(1), 300U);
  EXPECT_FALSE(sequence.ends_at_rest);
}

TEST(StartSequence, ComesToTheSameAngleAtALineThatIsBegunWith) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 20; ++trial) {
    DeviceSetup setup = small_setup();
    setup.increment = static_cast<std::uint64_t>(dice.between(1, 1 << 30));
    setup.increment -= setup.increment == 1U << 30U ? 1U : 0U;
    LineTiming timing{.slots_per_microvector = 5};
    if (dice.coin()) {
      setup.spin_up = {{1'000'000, 300}, {static_cast<std::uint64_t>(dice.between(1, 100'000'000)), 600}};
      setup.carriage.spin_up = {{1'000'000, static_cast<std::uint64_t>(2 * dice.between(1, 900))}};
    }
    Board whole;
    const StartSequence from_0 = expect_runs(whole, setup, timing, 0, 4);
    const std::int64_t line = dice.between(1, 3);
    Board later;
    const StartSequence from_line = expect_runs(later, setup, timing, 4 + line, 8);
    EXPECT_EQ(from_line.first_tick, from_0.first_tick + static_cast<std::uint64_t>(line) * 240);
    const std::uint64_t at = from_line.first_tick * kSeedClock;
    EXPECT_EQ(later.edges_at(at), whole.edges_at(at));
    EXPECT_GT(later.edges_at(at + 480), 0U);
  }
}

TEST(StartSequence, PutsOutWhatTheSpinUpSays) {
  DeviceSetup setup = small_setup();
  setup.fraction_num = 0;
  setup.fraction_den = 1;
  setup.spin_up = {{100'000'000, 3'000}, {400'000'000, 3'003}, {600'000'000, 6'000}};
  const emulator::ScheduleEnd end = emulator::run_schedule(
      setup.spin_up, {32, setup.prescaler, setup.increment, setup.fraction_num, setup.fraction_den}, 2);
  Board board;
  const StartSequence sequence = expect_runs(board, setup, {.slots_per_microvector = 5}, 0, 6);
  EXPECT_EQ(sequence.first_tick, kStartLead + 12'003);
  // The pins follow the schedule by a constant: what they show then lies within a step or two of what is due.
  const auto due = static_cast<std::uint64_t>(end.counts >> 30U);
  EXPECT_NEAR(static_cast<double>(board.edges_at(sequence.first_tick * kSeedClock + 30)), static_cast<double>(due),
              6.0);
}

TEST(StartSequence, EndsAtRestWhereItIsToldTo) {
  DeviceSetup setup = small_setup();
  setup.fraction_num = 0;
  setup.fraction_den = 1;
  Board board;
  const StartSequence sequence = expect_runs(board, setup, {.slots_per_microvector = 5, .stop_at_end = true}, 4, 8);
  EXPECT_TRUE(sequence.ends_at_rest);
  board.hold({}, 1'000);
  const std::uint64_t edges = board.edges(0);
  board.hold({}, 100'000);
  EXPECT_EQ(board.edges(0), edges);
  const fpga::AbRegisters registers{32, setup.prescaler, setup.increment, 0, 1};
  EXPECT_EQ(edges, fpga::position_after(registers, 4 * 480).edges) << "the edges of four lines, no more";
  EXPECT_EQ(board.read(fpga::kStatusRegister) & kStatusScheduleBusy, 0U);
}

TEST(StartSequence, RunsAgainOnABoardThatWasStoppedAnywhere) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  Board board;
  const DeviceSetup setup = small_setup();
  for (int trial = 0; trial < 10; ++trial) {
    const std::int64_t first = dice.between(0, 8);
    expect_runs(board, setup, {.slots_per_microvector = 5, .silence_seeds = 1'000'000}, first,
                first + dice.between(1, 3));
    if (dice.coin()) {
      board.hold({}, 500);  // the lines have run out: a fault stands
      EXPECT_EQ(board.fault(), 4);
    }
    board.write(stop_sequence({}, {}));
  }
}

TEST(StartSequence, TurnsTheAxisTheOtherWay) {
  const DeviceSetup setup = small_setup();
  Board board;
  const StartSequence onwards = expect_runs(board, setup, {.slots_per_microvector = 5}, 0, 4);
  const std::uint64_t edges = board.edges_at(onwards.first_tick * kSeedClock + 900);
  Board other;
  DeviceSetup returning = setup;
  returning.backward = true;
  const StartSequence backward = expect_runs(other, returning, {.slots_per_microvector = 5}, 0, 4);
  EXPECT_EQ(other.edges_at(backward.first_tick * kSeedClock + 900), edges);
  EXPECT_NE(backward.start, onwards.start);
}

TEST(StartSequence, DelaysBackwardLinesByPartOfASlot) {
  for (const std::int64_t later : {2, -2}) {
    const Result<StartSequence> sequence =
        start_sequence(small_setup(), {.slots_per_microvector = 5, .backward_later_ticks = later});
    ASSERT_TRUE(sequence);
    EXPECT_EQ(sequence.value().start.front().value & kControlBackward, kControlBackward);
    const RegisterWrite delay{fpga::kReverseDelayRegister.address, 1};
    EXPECT_EQ(std::count(sequence.value().settings.begin(), sequence.value().settings.end(), delay), 1);
  }
  EXPECT_EQ(framed_first_slot(7, true, {.backward_later_ticks = -2}).value(), 6);
  EXPECT_EQ(framed_first_slot(7, false, {.backward_later_ticks = -2}).value(), 7);
  EXPECT_FALSE(framed_first_slot(0, true, {.backward_later_ticks = -2}));
}

TEST(StartSequence, RefusesWhatTheBoardWould) {
  const auto refused = [](auto change, LineTiming timing, const char* part) {
    DeviceSetup setup = small_setup();
    change(setup);
    const Result<StartSequence> sequence = start_sequence(setup, timing);
    ASSERT_FALSE(sequence);
    EXPECT_NE(sequence.error().message.find(part), std::string::npos) << sequence.error().message;
  };
  const auto same = [](DeviceSetup&) {};
  refused(same, {.slots_per_microvector = 0}, "slots_per_microvector = 0: allowed is 1 to");
  refused([](DeviceSetup& setup) { setup.ticks_per_slot = 131'072; }, {},
          "seeds_per_slot = 65536: allowed is 1 to 65535");
  refused([](DeviceSetup& setup) { setup.fraction_den = std::uint64_t{1} << 34U; }, {}, "fraction_den = 17179869184");
  refused([](DeviceSetup& setup) { setup.spin_up.assign(255, {1, 300}); }, {}, "257 segments: its list holds 256");
  refused(same, {.backward_later_ticks = 3}, "leaves 3 ticks beside whole slots");
  refused(same, {.lines_before = 18'000'000}, "lines 0 to 17895696 come within that");
}

TEST(StartSequence, LeavesTheEndToTheHostWhereTheListIsTooShort) {
  DeviceSetup setup = small_setup();
  setup.lines_per_revolution = 1'000'000'000;
  setup.end_revolution = 10;
  const Result<StartSequence> sequence = start_sequence(setup, {.slots_per_microvector = 5, .stop_at_end = true});
  ASSERT_TRUE(sequence) << sequence.error().message;
  EXPECT_FALSE(sequence.value().ends_at_rest);
}

}  // namespace
}  // namespace gravure::protocol
