#include "gravure/core/exact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "dice.hpp"

namespace gravure {
namespace {

using test::Dice;

Integer random_integer(Dice& dice, int most_bits) {
  Integer value = 0;
  for (int bits = static_cast<int>(dice.between(0, most_bits)); bits > 0; bits -= 64) {
    value = (value << 64U) | dice.word();
  }
  return dice.coin() ? Integer(-value) : value;
}

Rational random_rational(Dice& dice, int most_bits) {
  Integer den = abs(random_integer(dice, most_bits)) + 1;
  return ratio(random_integer(dice, most_bits), den);
}

TEST(Ratio, IsInLowestTermsWithThePositiveDenominator) {
  EXPECT_EQ(to_string(ratio(6, -4)), "-3/2");
  EXPECT_EQ(to_string(ratio(-6, -3)), "2");
  EXPECT_EQ(to_string(ratio(0, -7)), "0");
  EXPECT_EQ(denominator_of(ratio(10, 4)), 2);
  EXPECT_EQ(numerator_of(ratio(10, -4)), -5);
}

TEST(Rounding, IsByItsDefinitionOnBothSidesOfZero) {
  struct Row {
    Rational value;
    int floor, ceil, round;
  };
  for (const Row& row : {Row{Rational(0), 0, 0, 0}, Row{ratio(1, 2), 0, 1, 1}, Row{ratio(-1, 2), -1, 0, -1},
                         Row{ratio(3, 2), 1, 2, 2}, Row{ratio(-3, 2), -2, -1, -2}, Row{ratio(1, 3), 0, 1, 0},
                         Row{ratio(-1, 3), -1, 0, 0}, Row{ratio(-2, 3), -1, 0, -1}, Row{Rational(-5), -5, -5, -5},
                         Row{Rational(5), 5, 5, 5}, Row{ratio(-9, 4), -3, -2, -2}}) {
    EXPECT_EQ(floor_of(row.value), row.floor) << row.value;
    EXPECT_EQ(ceil_of(row.value), row.ceil) << row.value;
    EXPECT_EQ(round_of(row.value), row.round) << row.value;
  }
}

TEST(Rounding, HoldsItsBoundsForAnyRatio) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 3000; ++trial) {
    const Rational value = random_rational(dice, 200);
    const Rational low(floor_of(value));
    const Rational high(ceil_of(value));
    ASSERT_TRUE(low <= value && value < low + 1) << value;
    ASSERT_TRUE(high >= value && value > high - 1) << value;
    ASSERT_LE(abs(Rational(Rational(round_of(value)) - value)), Rational(1, 2)) << value;
    ASSERT_EQ(round_of(Rational(-value)), -round_of(value)) << value;
  }
}

/// The exact value of a double.
Rational exact(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  const Integer whole(static_cast<std::int64_t>(std::ldexp(mantissa, 53)));
  exponent -= 53;
  const Integer power = Integer(1) << static_cast<unsigned>(std::abs(exponent));
  return exponent >= 0 ? Rational(Integer(whole * power)) : ratio(whole, power);
}

/// No double lies nearer, and of two equally near ones it is the even one.
void expect_nearest(const Rational& value) {
  const double got = to_double(value);
  ASSERT_TRUE(std::isfinite(got)) << value;
  const Rational error = abs(Rational(exact(got) - value));
  for (const double towards : {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}) {
    const double other = std::nextafter(got, towards);
    if (!std::isfinite(other)) {
      continue;
    }
    const Rational other_error = abs(Rational(exact(other) - value));
    ASSERT_LE(error, other_error) << value << " gave " << got;
    if (error == other_error) {
      int exponent = 0;
      ASSERT_EQ(std::fmod(std::ldexp(std::frexp(got, &exponent), 53), 2.0), 0.0) << value << " is a tie";
    }
  }
}

TEST(ToDouble, GivesTheNearestDouble) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 3000; ++trial) {
    expect_nearest(random_rational(dice, trial % 3 == 0 ? 60 : 700));
    expect_nearest(Rational(random_integer(dice, 900)));
  }
}

TEST(ToDouble, AgreesWithTheProcessorsDivision) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 20'000; ++trial) {
    const auto num = static_cast<std::int64_t>(dice.word() >> (11U + dice.word() % 50));
    const auto den = static_cast<std::int64_t>(dice.word() >> (11U + dice.word() % 50)) + 1;
    // Both are doubles, so IEEE division rounds their quotient once.
    ASSERT_EQ(to_double(ratio(num, den)), static_cast<double>(num) / static_cast<double>(den)) << num << "/" << den;
    ASSERT_EQ(to_double(ratio(-num, den)), -static_cast<double>(num) / static_cast<double>(den));
    ASSERT_EQ(to_double(Integer(num)), static_cast<double>(num));
  }
}

TEST(ToDouble, BreaksTiesToEvenAndLooksAtEveryBitBelow) {
  const Integer half_way = (Integer(1) << 100U) + (Integer(1) << 47U);  // between 2^100 and the next double
  EXPECT_EQ(to_double(half_way), std::ldexp(1.0, 100));
  EXPECT_EQ(to_double(Integer(half_way + 1)), std::nextafter(std::ldexp(1.0, 100), INFINITY));
  EXPECT_EQ(to_double(Integer(-half_way - 1)), -std::nextafter(std::ldexp(1.0, 100), INFINITY));
  const Rational tie = Rational(1) + ratio(1, Integer(1) << 53U);
  EXPECT_EQ(to_double(tie), 1.0);
  EXPECT_EQ(to_double(Rational(tie + ratio(1, Integer(1) << 2000U))), std::nextafter(1.0, 2.0));
}

TEST(ToDouble, RoundsOnceBelowTheNormalRange) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  const double smallest = std::numeric_limits<double>::denorm_min();
  for (int trial = 0; trial < 2000; ++trial) {
    const Integer den = Integer(1) << static_cast<unsigned>(dice.between(1020, 1200));
    expect_nearest(ratio(random_integer(dice, 120), den));
  }
  const Rational step = exact(smallest);
  EXPECT_EQ(to_double(Rational(step / 2)), 0.0);
  EXPECT_EQ(to_double(Rational(step * ratio(1'000'001, 2'000'000))), smallest);
  // 1.5 steps less a little is 1 step; rounded to 53 bits on the way it would become 1.5, and then 2.
  EXPECT_EQ(to_double(Rational(step * 3 / 2 - step / (Integer(1) << 80U))), smallest);
  EXPECT_EQ(to_double(Rational(-step * 3 / 2 + step / (Integer(1) << 80U))), -smallest);
}

TEST(ToDouble, OverflowsToInfinityAndKnowsNumbersWithHugeParts) {
  const Integer huge = Integer(1) << 5000U;
  EXPECT_EQ(to_double(huge), std::numeric_limits<double>::infinity());
  EXPECT_EQ(to_double(Integer(-huge)), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(to_double(ratio(3 * huge, 2 * huge)), 1.5);
  EXPECT_EQ(to_double(ratio(3 * huge + 1, 2 * huge)), 1.5);
  EXPECT_EQ(to_double(ratio(1, huge)), 0.0);
  EXPECT_EQ(to_double(exact(std::numeric_limits<double>::max())), std::numeric_limits<double>::max());
  EXPECT_EQ(to_double(Rational(0)), 0.0);
}

TEST(ToInt, FitsExactlyTheirRange) {
  const Integer most = std::numeric_limits<std::int64_t>::max();
  const Integer least = std::numeric_limits<std::int64_t>::min();
  const Integer unsigned_most = std::numeric_limits<std::uint64_t>::max();
  EXPECT_TRUE(fits_int64(most) && fits_int64(least) && fits_uint64(unsigned_most) && fits_uint64(0));
  EXPECT_FALSE(fits_int64(Integer(most + 1)));
  EXPECT_FALSE(fits_int64(Integer(least - 1)));
  EXPECT_FALSE(fits_uint64(Integer(unsigned_most + 1)));
  EXPECT_FALSE(fits_uint64(-1));
  EXPECT_EQ(to_int64(least, "x").value(), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(to_uint64(unsigned_most, "x").value(), std::numeric_limits<std::uint64_t>::max());
  const Result<std::int64_t> beyond = to_int64(Integer(most + 1), "job.ticks");
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, ErrorCode::out_of_range);
  EXPECT_EQ(beyond.error().message, "job.ticks = 9223372036854775808: beyond 64-bit integers");
  ASSERT_FALSE(to_uint64(-1, "edges"));
  EXPECT_EQ(to_uint64(-1, "edges").error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace gravure
