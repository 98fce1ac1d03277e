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

TEST(AbGenerator, ShowsTheCounterOneClockLaterAfterALoad) {
  const std::uint64_t seed = random_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  Words words(seed);
  for (int trial = 0; trial < 300; ++trial) {
    const AbRegisters registers = random_registers(words);
    AbGenerator generator({.bits = registers.bits, .prescaler_bits = 64, .fraction_bits = 64});
    AbGenerator::Inputs inputs = inputs_of(registers);
    auto counter = AbCounter::make(registers);
    inputs.load = true;
    EXPECT_FALSE(generator.step(inputs).refused);
    inputs.load = false;
    for (int clock = 1; clock <= 2000; ++clock) {
      const AbPins before = counter->pins();
      counter->step();
      const AbGenerator::Outputs now = generator.step(inputs);
      ASSERT_EQ(now.count, counter->counter());
      ASSERT_TRUE((AbPins{now.a, now.b} == before)) << "clock " << clock;
    }
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
    AbGenerator generator({.bits = registers.bits, .prescaler_bits = 64, .fraction_bits = 64});
    AbGenerator::Inputs inputs = inputs_of(registers);
    inputs.load = true;
    ASSERT_EQ(generator.step(inputs).refused, check(registers) != AbRefusal::none);
  }
}

}  // namespace
}  // namespace gravure::fpga
