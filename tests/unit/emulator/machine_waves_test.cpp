#include "gravure/emulator/machine_waves.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "dice.hpp"
#include "gravure/fpga/ab_counter.hpp"
#include "gravure/fpga/pulse_gate.hpp"
#include "recorder.hpp"

namespace gravure::emulator {
namespace {

using test::Frame;
using test::small_setup;

constexpr std::uint64_t kTicksOfLine = 60;
constexpr std::uint64_t kEnd = 12 * kTicksOfLine;

/// Puts the changes back to what a sample on every tick would be.
class Samples final : public WaveSink {
 public:
  bool begin(std::uint64_t first, const SignalValues& values) override {
    first_ = first;
    now_ = values;
    return true;
  }
  bool change(std::uint64_t tick, Signal signal, std::uint64_t value) override {
    EXPECT_GE(tick, first_ + samples_.size());
    EXPECT_NE(now_[static_cast<std::size_t>(signal)], value) << "no change at tick " << tick;
    fill(tick);
    now_[static_cast<std::size_t>(signal)] = value;
    return ++changes_ != stop_after_;
  }
  const std::vector<SignalValues>& to(std::uint64_t last) {
    fill(last + 1);
    return samples_;
  }
  int changes_ = 0;
  int stop_after_ = -1;

 private:
  void fill(std::uint64_t tick) {
    while (first_ + samples_.size() < tick) {
      samples_.push_back(now_);
    }
  }
  std::uint64_t first_ = 0;
  SignalValues now_{};
  std::vector<SignalValues> samples_;
};

MachineWaves::Setup wave_setup(std::uint64_t first, std::uint64_t last, std::int64_t slots_per_microvector) {
  return {.device = small_setup(),
          .slots_per_microvector = slots_per_microvector,
          .ticks_per_seed_clock = 1,
          .first_tick = first,
          .last_tick = last};
}

void run_lines(EmulatedDevice& device, std::int64_t first, std::int64_t last) {
  DeviceSetup setup = small_setup();
  setup.first_revolution = first / 4;
  setup.first_line = first % 4;
  ASSERT_TRUE(device.configure(setup));
  for (std::int64_t line = first; line <= last; ++line) {
    Frame frame(line / 4, line % 4);
    ASSERT_TRUE(device.send(*frame));
  }
}

/// Every tick of the job, by the models that know nothing but clocks.
std::vector<SignalValues> clock_by_clock(std::int64_t slots_per_microvector) {
  const DeviceSetup setup = small_setup();
  auto axis = fpga::AbCounter::make({.bits = setup.counter_bits,
                                     .prescaler = setup.prescaler,
                                     .increment = setup.increment,
                                     .fraction_num = setup.fraction_num,
                                     .fraction_den = setup.fraction_den});
  auto gate = fpga::PulseGate::make({.ticks_per_slot = 3, .slots_per_line = 20, .window_slots = 13});
  std::vector<SignalValues> samples;
  fpga::AbPins pins = axis->pins();
  for (std::uint64_t line = 0; line < 12; ++line) {
    Frame frame(static_cast<std::int64_t>(line / 4), static_cast<std::int64_t>(line % 4));
    gate->start_line(frame.bits(), static_cast<std::uint64_t>(frame->first_slot));
    for (std::uint64_t tick = 0; tick < kTicksOfLine; ++tick) {
      const auto slot = static_cast<std::int64_t>(tick / 3);
      const bool strobe = tick % 3 == 0;
      samples.push_back({pins.a ? 1U : 0U, pins.b ? 1U : 0U, gate->step().gate ? 1U : 0U, tick == 0 ? 1U : 0U,
                         strobe && slot % slots_per_microvector == 0 ? 1U : 0U, line / 4, line % 4});
      pins = axis->step();
    }
  }
  return samples;
}

TEST(MachineWaves, ShowsEveryTickOfAJobAsTheClockedModelsDo) {
  for (const std::int64_t microvector : {1, 4, 7}) {
    Samples samples;
    MachineWaves waves(wave_setup(0, kEnd - 1, microvector), samples);
    EmulatedDevice device(&waves);
    run_lines(device, 0, 11);
    waves.finish();
    EXPECT_EQ(samples.to(kEnd - 1), clock_by_clock(microvector)) << microvector;
  }
}

/// Every revolution a run of its own, to and fro.
DeviceSetup pass_setup(std::int64_t pass) {
  DeviceSetup setup = small_setup();
  setup.begin_revolution = setup.first_revolution = pass;
  setup.end_revolution = pass + 1;
  setup.backward = pass % 2 != 0;
  return setup;
}

TEST(MachineWaves, BeginEveryRunWithItsCounterAndGoBackWithThePinsExchanged) {
  for (const std::uint64_t first : {std::uint64_t{0}, 3 * kTicksOfLine + 7, 4 * kTicksOfLine, 6 * kTicksOfLine + 1}) {
    Samples samples;
    MachineWaves::Setup shown = wave_setup(first, kEnd - 1, 1);
    const std::int64_t first_pass = static_cast<std::int64_t>(first / (4 * kTicksOfLine));
    shown.device = pass_setup(first_pass);
    MachineWaves waves(shown, samples);
    EmulatedDevice device(&waves);
    for (std::int64_t pass = first_pass; pass < 3; ++pass) {
      if (pass > first_pass) {
        waves.start_run(pass_setup(pass));
      }
      ASSERT_TRUE(device.configure(pass_setup(pass)));
      for (std::int64_t line = 0; line < 4; ++line) {
        ASSERT_TRUE(test::send(device, pass, line));
      }
    }
    waves.finish();
    const std::vector<SignalValues>& seen = samples.to(kEnd - 1);
    ASSERT_EQ(seen.size(), kEnd - first);
    const DeviceSetup setup = small_setup();
    for (std::uint64_t tick = first; tick < kEnd; ++tick) {
      const std::uint64_t pass = tick / (4 * kTicksOfLine);
      const fpga::AbPins pins = fpga::position_after({.bits = setup.counter_bits,
                                                      .prescaler = setup.prescaler,
                                                      .increment = setup.increment,
                                                      .fraction_num = setup.fraction_num,
                                                      .fraction_den = setup.fraction_den},
                                                     tick - pass * 4 * kTicksOfLine)
                                    .pins;
      ASSERT_EQ(seen[tick - first][0], (pass == 1 ? pins.b : pins.a) ? 1U : 0U) << "A at tick " << tick;
      ASSERT_EQ(seen[tick - first][1], (pass == 1 ? pins.a : pins.b) ? 1U : 0U) << "B at tick " << tick;
      ASSERT_EQ(seen[tick - first][5], pass);
    }
  }
}

TEST(MachineWaves, ShowsAnyWindowOfThatFromItsOwnLinesAlone) {
  SCOPED_TRACE(gravure::test::Dice::note());
  gravure::test::Dice dice;
  const std::vector<SignalValues> all = clock_by_clock(4);
  for (int trial = 0; trial < 300; ++trial) {
    const std::uint64_t first = dice.word() % kEnd;
    const std::uint64_t last = trial == 0 ? first : first + dice.word() % (kEnd - first);
    Samples samples;
    MachineWaves waves(wave_setup(first, last, 4), samples);
    EmulatedDevice device(&waves);
    run_lines(device, static_cast<std::int64_t>(first / kTicksOfLine), static_cast<std::int64_t>(last / kTicksOfLine));
    waves.finish();
    const std::vector<SignalValues> expected(all.begin() + static_cast<std::ptrdiff_t>(first),
                                             all.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    ASSERT_EQ(samples.to(last), expected) << first << " to " << last;
  }
}

TEST(MachineWaves, HoldsStrobesForOneSeedClock) {
  MachineWaves::Setup setup = wave_setup(0, kEnd - 1, 5);
  setup.ticks_per_seed_clock = 2;
  Samples samples;
  MachineWaves waves(setup, samples);
  EmulatedDevice device(&waves);
  run_lines(device, 0, 11);
  waves.finish();
  const auto& seen = samples.to(kEnd - 1);
  for (std::uint64_t tick = 0; tick < kEnd; ++tick) {
    const std::uint64_t in_line = tick % kTicksOfLine;
    EXPECT_EQ(seen[tick][static_cast<std::size_t>(Signal::line_start)], in_line < 2 ? 1U : 0U) << tick;
    EXPECT_EQ(seen[tick][static_cast<std::size_t>(Signal::scanner_clock)], in_line % 15 < 2 ? 1U : 0U) << tick;
  }
}

TEST(MachineWaves, StopsWhenTheSinkWantsNoMore) {
  Samples samples;
  samples.stop_after_ = 3;
  MachineWaves waves(wave_setup(0, kEnd, 4), samples);
  EmulatedDevice device(&waves);
  run_lines(device, 0, 11);
  waves.finish();
  EXPECT_TRUE(waves.stopped());
  EXPECT_EQ(samples.changes_, 3);
}

}  // namespace
}  // namespace gravure::emulator
