#include "gravure/fpga/ab_counter.hpp"

#include <gtest/gtest.h>

#include <string>

#include "random_registers.hpp"

namespace gravure::fpga {
namespace {

using test::random_registers;
using test::random_seed;
using test::Words;

TEST(AbCounter, GivesThePublishedSequence) {
  auto counter = AbCounter::make({.bits = 6, .prescaler = 3, .increment = 7});
  ASSERT_TRUE(counter);
  std::string pins;
  for (int clock = 1; clock <= 36; ++clock) {
    const AbPins now = counter->step();
    pins += now.a ? (now.b ? '2' : '3') : (now.b ? '1' : '0');
  }
  EXPECT_EQ(pins, std::string(8, '0') + std::string(6, '1') + std::string(6, '2') + std::string(9, '3') +
                      std::string(6, '0') + "1");
}

TEST(AbCounter, NeverMovesBothPinsOnOneClock) {
  const std::uint64_t seed = random_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  Words words(seed);
  for (int trial = 0; trial < 500; ++trial) {
    auto counter = AbCounter::make(random_registers(words));
    ASSERT_TRUE(counter);
    AbPins before;
    for (int clock = 1; clock <= 2000; ++clock) {
      const AbPins now = counter->step();
      ASSERT_FALSE(now.a != before.a && now.b != before.b) << "trial " << trial << ", clock " << clock;
      before = now;
    }
  }
}

TEST(AbCounter, CarriesExactlyTheFraction) {
  auto counter = AbCounter::make({.bits = 64, .prescaler = 1, .increment = 10, .fraction_num = 3, .fraction_den = 7});
  ASSERT_TRUE(counter);
  for (int clock = 1; clock <= 7000; ++clock) {
    counter->step();
  }
  EXPECT_EQ(counter->counter(), 7000U * 10 + 3000U);
  EXPECT_EQ(counter->accumulator(), 0U);
}

TEST(AbCounter, AddsBeforeItComparesTheFraction) {
  auto counter = AbCounter::make({.bits = 64, .prescaler = 1, .increment = 0, .fraction_num = 1, .fraction_den = 2});
  ASSERT_TRUE(counter);
  counter->step();
  EXPECT_EQ(counter->counter(), 0U);  // acc 1
  counter->step();
  EXPECT_EQ(counter->counter(), 1U);  // acc 2 >= 2
}

TEST(AbCounter, RefusesWhatTheBoardWouldRefuse) {
  const AbRegisters good{.bits = 32, .prescaler = 1, .increment = 1U << 30U};
  EXPECT_EQ(check(good), AbRefusal::none);
  const auto refusal_of = [&good](auto change) {
    AbRegisters registers = good;
    change(registers);
    EXPECT_EQ(AbCounter::make(registers).has_value(), check(registers) == AbRefusal::none);
    return check(registers);
  };
  EXPECT_EQ(refusal_of([](AbRegisters& r) { r.bits = 3; }), AbRefusal::bits);
  EXPECT_EQ(refusal_of([](AbRegisters& r) { r.bits = 65; }), AbRefusal::bits);
  EXPECT_EQ(refusal_of([](AbRegisters& r) { r.bits = -1; }), AbRefusal::bits);
  EXPECT_EQ(refusal_of([](AbRegisters& r) { r.prescaler = 0; }), AbRefusal::prescaler);
  EXPECT_EQ(refusal_of([](AbRegisters& r) { r.fraction_den = 0; }), AbRefusal::fraction_den);
  EXPECT_EQ(refusal_of([](AbRegisters& r) { r.fraction_num = 1; }), AbRefusal::fraction_num);
  EXPECT_EQ(refusal_of([](AbRegisters& r) { ++r.increment; }), AbRefusal::increment);
  EXPECT_EQ(refusal_of([](AbRegisters& r) { r.increment = ~std::uint64_t{0}; }), AbRefusal::increment);
  const auto with_fraction = [](AbRegisters& r) { r.fraction_num = 1, r.fraction_den = 2; };
  EXPECT_EQ(refusal_of(with_fraction), AbRefusal::increment);  // the carry would make it 2^30 + 1
  EXPECT_EQ(refusal_of([&](AbRegisters& r) { with_fraction(r), --r.increment; }), AbRefusal::none);
  EXPECT_EQ(refusal_of([](AbRegisters& r) { r.bits = 64, r.increment = std::uint64_t{1} << 62U; }), AbRefusal::none);
  EXPECT_EQ(refusal_of([](AbRegisters& r) { r.bits = 64, r.increment = (std::uint64_t{1} << 62U) + 1; }),
            AbRefusal::increment);
}

}  // namespace
}  // namespace gravure::fpga
