#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "gravure/core/spin_phase.hpp"
#include "gravure/fpga/ab_counter.hpp"
#include "recorder.hpp"

namespace gravure::emulator {
namespace {

using test::Recorder;
using test::send;
using test::small_setup;

DeviceSetup random_setup(std::mt19937_64& rng) {
  DeviceSetup setup = small_setup();
  setup.counter_bits = static_cast<int>(8 + rng() % 57);
  setup.prescaler = 1 + rng() % 5;
  setup.fraction_den = (rng() >> (30 + rng() % 34)) | 1U;
  setup.fraction_num = rng() % setup.fraction_den;
  setup.increment = rng() % (std::uint64_t{1} << static_cast<unsigned>(setup.counter_bits - 2));
  setup.ticks_per_slot = static_cast<std::int64_t>(1 + rng() % 7);
  return setup;
}

/// Runs the counter clock by clock to each line's start and compares what can be seen: pins, edges, counts mod 2^64.
TEST(EmulatedDeviceAxis, EqualsTheCounterClockByClock) {
  std::mt19937_64 rng(1);
  for (int trial = 0; trial < 200; ++trial) {
    const DeviceSetup setup = random_setup(rng);
    Recorder recorder;
    EmulatedDevice device(&recorder);
    ASSERT_TRUE(device.configure(setup));
    auto counter = fpga::AbCounter::make({.bits = setup.counter_bits,
                                          .prescaler = setup.prescaler,
                                          .increment = setup.increment,
                                          .fraction_num = setup.fraction_num,
                                          .fraction_den = setup.fraction_den});
    ASSERT_TRUE(counter);
    const std::uint64_t mask = ~std::uint64_t{0} >> static_cast<unsigned>(64 - setup.counter_bits);
    std::uint64_t edges = 0;
    fpga::AbPins before;
    for (std::int64_t ordinal = 0; ordinal < 12; ++ordinal) {
      ASSERT_TRUE(send(device, ordinal / 4, ordinal % 4));
      const Recorder::Line& line = recorder.lines.back();
      while (counter->clock() < static_cast<std::uint64_t>(line.start_tick)) {
        const fpga::AbPins now = counter->step();
        edges += now == before ? 0 : 1;
        before = now;
      }
      ASSERT_EQ(line.axis.edges, edges);
      ASSERT_EQ(line.axis.counts_low & mask, counter->counter());
    }
  }
}

/// The second channel is a counter like the first, with registers of its own.
TEST(EmulatedDeviceAxis, CarriageIsTheSecondChannel) {
  std::mt19937_64 rng(2);
  for (int trial = 0; trial < 50; ++trial) {
    DeviceSetup setup = random_setup(rng);
    DeviceSetup other = random_setup(rng);
    other.fraction_num = 0;
    setup.counter_bits = other.counter_bits;
    setup.increment = 1;
    setup.carriage = {other.prescaler, other.increment, other.fraction_num, other.fraction_den};
    DeviceSetup alone = setup;
    alone.prescaler = other.prescaler;
    alone.increment = other.increment;
    alone.fraction_num = other.fraction_num;
    alone.fraction_den = other.fraction_den;
    Recorder both;
    Recorder first;
    EmulatedDevice device(&both);
    EmulatedDevice reference(&first);
    ASSERT_TRUE(device.configure(setup));
    ASSERT_TRUE(reference.configure(alone));
    for (std::int64_t ordinal = 0; ordinal < 12; ++ordinal) {
      ASSERT_TRUE(send(device, ordinal / 4, ordinal % 4));
      ASSERT_TRUE(send(reference, ordinal / 4, ordinal % 4));
      ASSERT_EQ(both.lines.back().carriage.edges, first.lines.back().axis.edges);
      ASSERT_EQ(both.lines.back().carriage.counts_low, first.lines.back().axis.counts_low);
    }
    ASSERT_EQ(device.status().carriage.edges, reference.status().axis.edges);
  }
}

TEST(EmulatedDeviceAxis, CarriageStandsStillUnlessAsked) {
  Recorder recorder;
  EmulatedDevice device(&recorder);
  ASSERT_TRUE(device.configure(small_setup()));
  ASSERT_TRUE(send(device, 0, 0));
  EXPECT_EQ(device.status().carriage.edges, 0);
}

TEST(EmulatedDeviceAxis, CarriageRegistersAreChecked) {
  EmulatedDevice device;
  DeviceSetup setup = small_setup();
  setup.carriage.increment = (1U << 14U) + 1;
  test::expect_refused(device.configure(setup), {"the board refuses carriage.increment = 16385"});
  setup.carriage = {0, 5, 0, 1};
  test::expect_refused(device.configure(setup), {"carriage.prescaler = 0"});
  setup.carriage = {1, 5, 1, 2};
  test::expect_refused(device.configure(setup),
                       {"carriage.fraction_num = 1: allowed is 0", "second axis has no fraction"});
}

void expect_same(const AxisState& a, const AxisState& b) {
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_EQ(a.counts_high, b.counts_high);
  EXPECT_EQ(a.counts_low, b.counts_low);
}

TEST(EmulatedDeviceAxis, StandsAtAnyFirstLineWhereARunFromTheStartGetsTo) {
  for (std::int64_t first = 0; first < 12; ++first) {
    SCOPED_TRACE(first);
    Recorder whole;
    Recorder late;
    EmulatedDevice from_start(&whole);
    EmulatedDevice resumed(&late);
    DeviceSetup setup = small_setup();
    ASSERT_TRUE(from_start.configure(setup));
    setup.first_revolution = first / 4;
    setup.first_line = first % 4;
    ASSERT_TRUE(resumed.configure(setup));
    for (std::int64_t ordinal = 0; ordinal < 12; ++ordinal) {
      if (ordinal >= first) {
        EXPECT_EQ(from_start.status().tick, resumed.status().tick);
        expect_same(from_start.status().axis, resumed.status().axis);
        ASSERT_TRUE(send(resumed, ordinal / 4, ordinal % 4));
      }
      ASSERT_TRUE(send(from_start, ordinal / 4, ordinal % 4));
      if (ordinal >= first) {
        EXPECT_EQ(whole.lines.back().start_tick, late.lines.back().start_tick);
        EXPECT_EQ(whole.lines.back().ordinal, late.lines.back().ordinal);
        EXPECT_EQ(whole.lines.back().fired, late.lines.back().fired);
        expect_same(whole.lines.back().axis, late.lines.back().axis);
      }
    }
    EXPECT_EQ(from_start.status().lines_executed, 12);
    EXPECT_EQ(resumed.status().lines_executed, 12 - first);
  }
}

TEST(EmulatedDeviceAxis, StatusTellsTheAxisAtItsTick) {
  Recorder recorder;
  EmulatedDevice device(&recorder);
  expect_same(device.status().axis, AxisState{});
  ASSERT_TRUE(device.configure(small_setup()));
  ASSERT_TRUE(send(device, 0, 0));
  const AxisState before = device.status().axis;
  ASSERT_TRUE(send(device, 0, 1));
  expect_same(before, recorder.lines.back().axis);
}

/// Revolution `revolution` of small_setup() alone, as a run.
DeviceSetup run_setup(std::int64_t revolution, bool backward) {
  DeviceSetup setup = small_setup();
  setup.begin_revolution = setup.first_revolution = revolution;
  setup.end_revolution = revolution + 1;
  setup.backward = backward;
  return setup;
}

TEST(EmulatedDeviceAxis, CountsFromTheFirstLineOfItsRunAndBackwardsBelowZero) {
  Recorder forward;
  Recorder backward;
  EmulatedDevice first(&forward);
  EmulatedDevice second(&backward);
  ASSERT_TRUE(first.configure(run_setup(0, false)));
  DeviceSetup back = run_setup(1, true);
  back.carriage.increment = 777;
  ASSERT_TRUE(second.configure(back));
  for (std::int64_t line = 0; line < 4; ++line) {
    ASSERT_TRUE(send(first, 0, line));
    ASSERT_TRUE(send(second, 1, line));
    const AxisState there = forward.lines.back().axis;
    const AxisState way_back = backward.lines.back().axis;
    EXPECT_EQ(way_back.edges, -there.edges);
    EXPECT_EQ(counts_of(way_back), -counts_of(there));
    EXPECT_GE(backward.lines.back().carriage.edges, 0) << "the other channel has one way";
    EXPECT_EQ(backward.lines.back().ordinal, line + 4);
  }
  EXPECT_LT(second.status().axis.edges, 0);
  test::expect_refused(send(second, 2, 0), {"the run up to revolution 1 is over"});
}

TEST(EmulatedDeviceAxis, GoesToRestAfterTheLastLineOfTheRunAlone) {
  for (const bool backward : {false, true}) {
    DeviceSetup setup = run_setup(1, backward);
    setup.spin_up = {{100, 20}, {600, 8}};
    setup.spin_down = {{900, 6}, {50, 4}};
    EmulatedDevice device;
    ASSERT_TRUE(device.configure(setup));
    for (std::int64_t line = 0; line < 4; ++line) {
      EXPECT_FALSE(device.status().axis_at_rest);
      ASSERT_TRUE(send(device, 1, line));
    }
    // On every second of 28 + 240 + 10 ticks a step, each with 5/7 of a count more.
    const Integer counts = 10 * 100 + 4 * 600 + 120 * 1234 + 3 * 900 + 2 * 50 + 139 * 5 / 7;
    ASSERT_TRUE(device.status().axis_at_rest);
    EXPECT_EQ(counts_of(*device.status().axis_at_rest), backward ? Integer(-counts) : counts);
    EXPECT_EQ(device.status().axis_at_rest->edges, static_cast<std::int64_t>(counts / (1 << 14)) * (backward ? -1 : 1));
    EXPECT_FALSE(device.status().carriage_at_rest) << "it has no spin-down";
  }
}

TEST(EmulatedDeviceAxis, CountsBeyondSixtyFourBits) {
  DeviceSetup setup = small_setup();
  setup.counter_bits = 64;
  setup.prescaler = 1;
  setup.increment = (std::uint64_t{1} << 62U) - 1;
  Recorder recorder;
  EmulatedDevice device(&recorder);
  ASSERT_TRUE(device.configure(setup));
  ASSERT_TRUE(send(device, 0, 0));
  ASSERT_TRUE(send(device, 0, 1));
  // 60 * (2^62 - 1) + floor(60 * 5 / 7) = 15 * 2^64 - 60 + 42
  EXPECT_EQ(recorder.lines.back().axis.counts_high, 14);
  EXPECT_EQ(recorder.lines.back().axis.counts_low, ~std::uint64_t{0} - 17);
  EXPECT_EQ(recorder.lines.back().axis.edges, 59);
}

}  // namespace
}  // namespace gravure::emulator
