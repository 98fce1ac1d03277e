#include "gravure/fpga/ab_generator.hpp"

#include <gtest/gtest.h>

#include "gravure/fpga/ab_counter.hpp"
#include "random_registers.hpp"

namespace gravure::fpga {
namespace {

using test::random_registers;
using test::random_seed;
using test::Words;

AbGenerator::Inputs inputs_of(const AbRegisters& registers) {
  return {.enable = true,
          .increment = registers.increment,
          .prescaler = registers.prescaler,
          .fraction_num = registers.fraction_num,
          .fraction_den = registers.fraction_den};
}

AbGenerator::Widths widths_of(const AbRegisters& registers) {
  const int segment = registers.bits % 8 == 0 ? 8 : registers.bits;
  return {.bits = registers.bits, .prescaler_bits = 64, .fraction_bits = 64, .segment_bits = segment};
}

/// A generator that counts: its load was on FPGA clock 0, the clocks since then are `steps`.
struct Running {
  explicit Running(const AbRegisters& registers, bool backward = false)
      : widths(widths_of(registers)), inputs(inputs_of(registers)), generator(widths) {
    generator.step({.rst = true});
    generator.step({.rst = true});
    inputs.load = true;
    inputs.backward = backward;
    generator.step(inputs);
    inputs.load = false;
  }
  AbPins step() {
    const AbGenerator::Outputs now = generator.step(inputs);
    return {now.a, now.b};
  }

  AbGenerator::Widths widths;
  AbGenerator::Inputs inputs;
  AbGenerator generator;
};

TEST(AbGenerator, ShowsTheCounterItsLoadLatencyLater) {
  const std::uint64_t seed = random_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  Words words(seed);
  for (int trial = 0; trial < 500; ++trial) {
    const AbRegisters registers = random_registers(words);
    Running running(registers);
    auto counter = AbCounter::make(registers);
    for (int clock = 1; clock <= AbGenerator::load_latency(running.widths); ++clock) {
      ASSERT_TRUE(running.step() == AbPins{}) << "clock " << clock;
    }
    for (int clock = 1; clock <= 2000; ++clock) {
      ASSERT_TRUE(running.step() == counter->step()) << "clock " << clock << " of trial " << trial;
    }
  }
}

TEST(AbGenerator, ExchangesThePinsWhenLoadedBackward) {
  const std::uint64_t seed = random_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  Words words(seed);
  for (int trial = 0; trial < 500; ++trial) {
    const AbRegisters registers = random_registers(words);
    Running forward(registers);
    Running backward(registers, true);
    for (int clock = 1; clock <= 2000; ++clock) {
      const AbPins pins = forward.step();
      backward.inputs.backward = words.below(2) == 0;  // means nothing between loads
      ASSERT_TRUE((backward.step() == AbPins{.a = pins.b, .b = pins.a})) << "clock " << clock << " of trial " << trial;
    }
  }
}

/// Quarter turns from one pair of pins to the next, 2 where both change.
int moved(AbPins from, AbPins to) {
  const auto quarter = [](AbPins pins) { return pins.a ? (pins.b ? 2 : 3) : pins.b ? 1 : 0; };
  const int quarters = (quarter(to) - quarter(from)) & 3;
  return quarters == 3 ? -1 : quarters;
}

TEST(AbGenerator, TurnsWithTheFirstWordOfALoadAndLosesNoEdge) {
  const std::uint64_t seed = random_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  Words words(seed);
  for (int trial = 0; trial < 200; ++trial) {
    AbRegisters registers = random_registers(words);
    Running forward(registers);
    Running turning(registers);
    const int latency = AbGenerator::load_latency(turning.widths);
    int way = 1;
    int next_way = 1;
    int turns_at = latency + 1;  // of the first load
    AbPins forward_before;
    AbPins turning_before;
    for (int clock = 1; clock <= 3000; ++clock) {
      const bool loads = clock % 2 == 0 && clock > turns_at && words.below(40) == 0;
      if (loads) {
        registers.increment = words.word() % (max_increment(registers) + 1);
        turns_at = clock + latency + 1;  // its first word shows there
        next_way = words.below(2) == 0 ? 1 : -1;
      }
      for (Running* each : {&forward, &turning}) {
        each->inputs.load = loads || (clock % 2 != 0 && each->inputs.load);
        each->inputs.increment = registers.increment;
      }
      turning.inputs.backward = next_way < 0;
      way = clock == turns_at ? next_way : way;
      const AbPins forward_now = forward.step();
      const AbPins turning_now = turning.step();
      ASSERT_EQ(moved(turning_before, turning_now), way * moved(forward_before, forward_now))
          << "clock " << clock << " of trial " << trial;
      forward_before = forward_now;
      turning_before = turning_now;
    }
  }
}

TEST(AbGenerator, StandsItsEnableLatencyAfterEnableFalls) {
  const AbRegisters registers{.bits = 32, .increment = std::uint64_t{1} << 30U};  // an edge on every clock
  Running running(registers);
  for (int clock = 1; clock < 101; ++clock) {
    running.step();
  }
  running.inputs.enable = false;  // not looked at before FPGA clock 102, the next seed clock
  AbPins before;
  for (int clock = 101; clock < 200; ++clock) {
    const AbPins now = running.step();
    const bool stands = clock >= 102 + AbGenerator::enable_latency(running.widths);
    if (clock > 101) {
      ASSERT_EQ(now == before, stands) << "clock " << clock;
    }
    before = now;
  }
}

TEST(AbGenerator, TakesAnIncrementItsIncrementLatencyLaterWithoutAGap) {
  const AbRegisters registers{.bits = 32, .increment = 0};
  Running running(registers);
  for (int clock = 1; clock < 100; ++clock) {
    running.step();
  }
  running.inputs.load_increment = true;
  running.inputs.increment = std::uint64_t{1} << 30U;
  AbPins before;
  for (int clock = 100; clock < 200; ++clock) {  // 100 is a seed clock
    const AbPins now = running.step();
    running.inputs.load_increment = false;
    const bool moves = clock >= 100 + AbGenerator::increment_latency(running.widths);
    ASSERT_EQ(!(now == before), moves) << "clock " << clock;
    before = now;
  }
}

TEST(AbGenerator, RefusesExactlyWhatCheckRefuses) {
  Words words(random_seed());
  for (int trial = 0; trial < 20'000; ++trial) {
    AbRegisters registers = random_registers(words);
    if (words.below(2) == 0) {
      registers.increment = (max_increment(registers) + words.below(3)) & (~std::uint64_t{0} >> (64 - registers.bits));
    }
    if (words.below(4) == 0) {
      registers.fraction_den = registers.fraction_num;
    }
    registers.prescaler = words.below(10);
    Running running(registers);
    AbGenerator::Outputs now;
    do {
      now = running.generator.step(running.inputs);
    } while (now.busy);
    ASSERT_EQ(now.refused, check(registers) != AbRefusal::none);
  }
}

TEST(AbGenerator, RefusesALoadWhileOneIsUnderWay) {
  Running running({.bits = 32, .increment = std::uint64_t{1} << 30U});
  running.step();
  running.inputs.load = true;
  running.inputs.increment = 1;
  running.step();
  running.inputs.load = false;
  AbGenerator::Outputs now;
  for (int clock = 0; clock <= AbGenerator::load_latency(running.widths); ++clock) {
    now = running.generator.step(running.inputs);
  }
  EXPECT_FALSE(now.busy);
  const AbPins before{now.a, now.b};
  EXPECT_FALSE(running.step() == before);  // the first load runs
}

}  // namespace
}  // namespace gravure::fpga
