#include <gtest/gtest.h>

#include "gravure/core/exact.hpp"

namespace gravure {
namespace {

/// scale * arctan(1/x) by its series, each term cut: the error is below the number of terms.
Integer arctan_of_inverse(int x, const Integer& scale) {
  Integer power = scale / x;
  Integer sum = power;
  const Integer square = Integer(x) * x;
  for (int n = 3; power != 0; n += 2) {
    power /= square;
    sum += (n % 4 == 3 ? Integer(-power) : power) / n;
  }
  return sum;
}

TEST(Pi, HasTheDigitsOfMachinsSeries) {
  const Integer hundred = boost::multiprecision::pow(Integer(10), 100U);
  const Integer guard = boost::multiprecision::pow(Integer(10), 20U);
  const Integer machin =
      4 * (4 * arctan_of_inverse(5, Integer(hundred * guard)) - arctan_of_inverse(239, Integer(hundred * guard)));
  EXPECT_EQ(pi() * Rational(hundred), Rational(round_of(ratio(machin, guard)))) << "pi to the nearest 100th decimal";
  const Rational error = abs(Rational(pi() - ratio(machin, Integer(hundred * guard))));
  EXPECT_LT(error, ratio(1, hundred));
}

}  // namespace
}  // namespace gravure
