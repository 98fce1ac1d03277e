#include "gravure/sync/ab_ratio.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <optional>

#include "sync_support.hpp"

namespace gravure {
namespace {

using sync_test::Random;
using sync_test::seed_note;

constexpr std::uint64_t kMost64 = std::numeric_limits<std::uint64_t>::max();

Rational quotient(const AbPair& pair) {
  return ratio(pair.increment, pair.prescaler);
}

/// The definition itself: every m, the increments next to m X, the best by exact comparison.
std::optional<AbPair> brute_force(const Rational& wanted, int bits, std::uint64_t max_prescaler, const Rational& most) {
  std::optional<AbPair> best;
  Rational best_error;
  for (std::uint64_t m = 1; m <= max_prescaler; ++m) {
    const Integer below = floor_of(Rational(wanted * Rational(m)));
    for (const Integer& increment : {below, Integer(below + 1), Integer(1)}) {
      if (increment < 1 || increment > largest_increment(bits) || ratio(increment, m) > most) {
        continue;
      }
      const Rational error = abs(Rational(ratio(increment, m) - wanted));
      const auto value = static_cast<std::uint64_t>(increment);
      const bool tie = best && error == best_error && best->prescaler == m && value < best->increment;
      if (!best || error < best_error || tie) {
        best = AbPair{.prescaler = m, .increment = value};
        best_error = error;
      }
    }
  }
  return best;
}

TEST(BestAbPair, EqualsBruteForceOnRandomBoxes) {
  SCOPED_TRACE(seed_note());
  Random random;
  int with_cap = 0;
  int solved = 0;
  for (int trial = 0; trial < 6000; ++trial) {
    const int bits = static_cast<int>(random.between(2, 12));
    const std::uint64_t max_prescaler = random.between(1, 60);
    const std::uint64_t den = random.between(1, 400);
    const Rational wanted = ratio(random.between(1, largest_increment(bits) * den), den);
    const Rational slack = ratio(random.between(0, 100), 1000);
    const bool capped = random.chance(2);
    const Rational most = capped ? Rational(wanted * (1 + slack)) : Rational(largest_increment(bits));
    const auto expected = brute_force(wanted, bits, max_prescaler, most);
    const auto pair = best_ab_pair(wanted, bits, max_prescaler, most);
    ASSERT_EQ(expected.has_value(), static_cast<bool>(pair)) << to_string(wanted) << " n=" << bits;
    with_cap += capped ? 1 : 0;
    solved += pair ? 1 : 0;
    if (pair) {
      ASSERT_EQ(*expected, pair.value()) << to_string(wanted) << " n=" << bits << " m_max=" << max_prescaler
                                         << " cap=" << to_string(most) << " got " << pair.value().increment << "/"
                                         << pair.value().prescaler;
    }
  }
  EXPECT_GT(with_cap, 2500);
  EXPECT_GT(solved, 5000);
}

TEST(BestAbPair, EqualsBruteForceWith64BitCounters) {
  SCOPED_TRACE(seed_note());
  Random random;
  for (int trial = 0; trial < 1500; ++trial) {
    const std::uint64_t den = trial == 0 ? kMost64 : random.between(1, kMost64);
    const std::uint64_t num = trial == 0 ? kMost64 - 1 : random.between(1, kMost64);
    const Rational wanted = ratio(num, den) * Rational(random.between(1, largest_increment(64) / 8)) / 8;
    if (wanted > Rational(largest_increment(64))) {
      continue;
    }
    const std::uint64_t max_prescaler = random.between(1, 40);
    const auto pair = best_ab_pair(wanted, 64, max_prescaler, Rational(largest_increment(64)));
    ASSERT_TRUE(pair) << pair.error().message;
    ASSERT_EQ(*brute_force(wanted, 64, max_prescaler, Rational(largest_increment(64))), pair.value())
        << to_string(wanted) << " m_max=" << max_prescaler;
  }
}

/// The fraction strictly between low >= 0 and high with the smallest denominator; it has the smallest numerator too.
Rational simplest_between(const Rational& low, const Rational& high) {
  const Integer whole = floor_of(low);
  if (Rational(whole + 1) < high) {
    return whole + 1;
  }
  const Rational rest_high = high - Rational(whole);
  if (low == Rational(whole)) {
    return Rational(whole) + ratio(1, floor_of(Rational(1 / rest_high)) + 1);
  }
  return Rational(whole) + 1 / simplest_between(1 / rest_high, 1 / Rational(low - Rational(whole)));
}

/// In boxes too large to search: even the simplest fraction closer to X lies outside the box, hence all do.
TEST(BestAbPair, LeavesNothingCloserInLargeBoxes) {
  SCOPED_TRACE(seed_note());
  Random random;
  int checked = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const int bits = static_cast<int>(random.between(30, 64));
    const std::uint64_t max_prescaler = random.between(1, random.between(1, kMost64));
    const Rational most(largest_increment(bits));
    const Rational wanted = ratio(random.between(1, random.between(1, kMost64)), random.between(1, kMost64));
    if (wanted > most || wanted < ratio(1, max_prescaler)) {
      continue;
    }
    const auto pair = best_ab_pair(wanted, bits, max_prescaler, most);
    ASSERT_TRUE(pair);
    const Rational error = abs(Rational(quotient(pair.value()) - wanted));
    if (error == 0) {
      continue;
    }
    ++checked;
    const Rational closer = simplest_between(std::max(Rational(0), Rational(wanted - error)), wanted + error);
    EXPECT_TRUE(denominator_of(closer) > max_prescaler || numerator_of(closer) > largest_increment(bits))
        << to_string(closer) << " is closer to " << to_string(wanted);
  }
  EXPECT_GT(checked, 1000);
}

TEST(BestAbPair, IsNeverWorseWithMorePrescalerOrMoreBits) {
  SCOPED_TRACE(seed_note());
  Random random;
  for (int trial = 0; trial < 2000; ++trial) {
    const int bits = static_cast<int>(random.between(8, 40));
    const Rational wanted = ratio(random.between(1, largest_increment(bits)), random.between(1, 1'000'000));
    const std::uint64_t max_prescaler = random.between(1, 100'000);
    const Rational most(largest_increment(bits));
    const auto error = [&](int n, std::uint64_t m_max) {
      const Rational scaled = wanted * Rational(Integer(1) << static_cast<unsigned>(n - bits));
      const auto pair = best_ab_pair(scaled, n, m_max, Rational(largest_increment(n)));
      EXPECT_TRUE(pair);
      return abs(Rational(quotient(pair.value()) / scaled - 1));
    };
    const Rational base = error(bits, max_prescaler);
    EXPECT_LE(error(bits, max_prescaler + random.between(1, 1000)), base);
    EXPECT_LE(error(bits + 1, max_prescaler), base);
    EXPECT_LE(base, error(bits, 1));
    // Publication [B] takes the nearest integer at m = 1.
    const Integer nearest = std::max(Integer(1), round_of(wanted));
    EXPECT_LE(base, abs(Rational(Rational(nearest) / wanted - 1)));
  }
}

struct Setup1Vector {
  std::int64_t slots;
  const char* wanted_num;
  std::int64_t wanted_den;
  AbPair first;  ///< m = 1
  const char* first_rel;
  std::int64_t first_lines;  ///< to 1/16 line
  AbPair best;
  const char* best_rel;
  std::int64_t best_lines;
};

const Setup1Vector kSetup1Vectors[] = {{3909,
                                        "208291482765885440",
                                        4405634541,
                                        {1, 47278430},
                                        "148636519/20829148276588544",
                                        8758425,
                                        {3, 141835289},
                                        "17820343/208291482765885440",
                                        730525652},
                                       {3920,
                                        "2603643534573568",
                                        55225401,
                                        {1, 47145761},
                                        "22101593/2603643534573568",
                                        7362715,
                                        {5, 235728803},
                                        "57163/13018217672867840",
                                        14233658216},
                                       {4000,
                                        "1301821767286784",
                                        28176225,
                                        {1, 46202845},
                                        "-10926659/1301821767286784",
                                        7446363,
                                        {18, 831651217},
                                        "184571/7810930603720704",
                                        2644961358},
                                       {4096,
                                        "50852412784640",
                                        1127049,
                                        {1, 45119966},
                                        "-112153/25426206392320",
                                        14169375,
                                        {5, 225599831},
                                        "5519/254262063923200",
                                        2879394636}};

TEST(BestAbPair, GivesTheVectorsOfSetup1) {
  for (const Setup1Vector& vector : kSetup1Vectors) {
    SCOPED_TRACE(vector.slots);
    const Rational wanted_hz = ratio(Integer(2'000'000) * 11'840 << 13U, Integer(vector.slots) * 27'489);
    const Rational wanted = increment_per_clock(wanted_hz, 32, Rational(164'000'000));
    EXPECT_EQ(wanted, ratio(Integer(vector.wanted_num), vector.wanted_den));
    const Rational most(largest_increment(32));
    const auto first = best_ab_pair(wanted, 32, 1, most).value();
    const auto best = best_ab_pair(wanted, 32, 4'294'967'295U, most).value();
    EXPECT_EQ(first, vector.first);
    EXPECT_EQ(best, vector.best);
    const Rational first_rel = quotient(first) / wanted - 1;
    const Rational best_rel = quotient(best) / wanted - 1;
    EXPECT_EQ(to_string(first_rel), vector.first_rel);
    EXPECT_EQ(to_string(best_rel), vector.best_rel);
    EXPECT_EQ(ceil_of(Rational(Rational(1, 16) / abs(first_rel))), vector.first_lines);
    EXPECT_EQ(ceil_of(Rational(Rational(1, 16) / abs(best_rel))), vector.best_lines);
  }
}

TEST(BestAbPair, GivesTheVectorOfSetup2) {
  const Rational wanted = ratio(Integer("6710886400"), 8487);
  const auto best = best_ab_pair(wanted, 32, 4'294'967'295U, Rational(largest_increment(32))).value();
  EXPECT_EQ(best, (AbPair{.prescaler = 462, .increment = 365'315'131}));
  EXPECT_EQ(to_string(Rational(quotient(best) / wanted - 1)), "-1/1033476505600");
}

TEST(BestAbPair, TakesTheSlowestWhenTheWantedIsSlower) {
  const auto pair = best_ab_pair(ratio(1, 1'000'000), 32, 1000, Rational(1)).value();
  EXPECT_EQ(pair, (AbPair{.prescaler = 1000, .increment = 1}));
}

TEST(BestAbPair, BreaksTiesTowardsTheSmallerPrescalerThenIncrement) {
  // 5/2 lies midway between 2 and 3, both with m = 1.
  EXPECT_EQ(best_ab_pair(ratio(5, 2), 8, 1, Rational(64)).value(), (AbPair{.prescaler = 1, .increment = 2}));
  // 3/4 midway between 1/2 and 1: m = 1 wins.
  EXPECT_EQ(best_ab_pair(ratio(3, 4), 8, 2, Rational(64)).value(), (AbPair{.prescaler = 1, .increment = 1}));
}

TEST(BestAbPair, TakesTheExtremesExactly) {
  const Rational most(largest_increment(64));
  EXPECT_EQ(best_ab_pair(most, 64, kMost64, most).value(),
            (AbPair{.prescaler = 1, .increment = largest_increment(64)}));
  EXPECT_EQ(best_ab_pair(ratio(1, kMost64), 64, kMost64, most).value(), (AbPair{.prescaler = kMost64, .increment = 1}));
}

TEST(BestAbPair, RefusesWhatTheCounterCannotEmit) {
  const auto refused = [](const Rational& wanted, int bits, std::uint64_t m_max, const Rational& most) {
    const auto pair = best_ab_pair(wanted, bits, m_max, most);
    EXPECT_FALSE(pair);
    EXPECT_EQ(pair.error().code, ErrorCode::out_of_range);
    return pair.error().message;
  };
  EXPECT_NE(refused(ratio(129, 2), 8, 5, Rational(1000)).find("at most 2^(n-2) = 64"), std::string::npos);
  EXPECT_NE(refused(Rational(3), 8, 5, ratio(5, 2)).find("at most 2.5"), std::string::npos);
  EXPECT_NE(refused(ratio(1, 100), 8, 5, ratio(1, 50)).find("at least 50 would fit"), std::string::npos);
  EXPECT_NE(refused(Rational(0), 8, 5, Rational(1)).find("greater than 0"), std::string::npos);
  EXPECT_NE(refused(Rational(-1), 8, 5, Rational(1)).find("greater than 0"), std::string::npos);
  EXPECT_NE(refused(Rational(1), 8, 0, Rational(1)).find("max_prescaler = 0"), std::string::npos);
  EXPECT_NE(refused(Rational(1), 1, 1, Rational(1)).find("must be 2 to 64"), std::string::npos);
  EXPECT_NE(refused(Rational(1), 65, 1, Rational(1)).find("must be 2 to 64"), std::string::npos);
}

/// a/b in lowest terms, all of them for n = 8: against the criterion and against a search over m.
TEST(ExactAbPair, ExistsWhereTheCriterionSays) {
  constexpr int kBits = 8;
  constexpr std::uint64_t kMaxPrescaler = 40;
  int exact = 0;
  for (std::uint64_t b = 1; b <= 400; ++b) {
    for (std::uint64_t a = 1; 4 * a <= b; ++a) {
      if (std::gcd(a, b) != 1) {
        continue;
      }
      const Rational wanted = ratio(Integer(a) << kBits, b);
      const auto pair = exact_ab_pair(wanted, kBits, kMaxPrescaler);
      const int twos = std::min(kBits, __builtin_ctzll(b));
      const std::uint64_t power = std::uint64_t{1} << static_cast<unsigned>(twos);
      const bool expected = 4 * a <= power && b / power <= kMaxPrescaler;
      ASSERT_EQ(pair.has_value(), expected) << a << "/" << b;
      std::optional<AbPair> searched;
      for (std::uint64_t m = 1; m <= kMaxPrescaler && !searched; ++m) {
        const Rational increment = wanted * Rational(m);
        if (denominator_of(increment) == 1 && increment <= Rational(largest_increment(kBits))) {
          searched = AbPair{.prescaler = m, .increment = static_cast<std::uint64_t>(numerator_of(increment))};
        }
      }
      ASSERT_EQ(pair, searched) << a << "/" << b;
      if (pair) {
        ++exact;
        EXPECT_EQ(pair->prescaler, b / power);
        EXPECT_EQ(pair->increment, a << static_cast<unsigned>(kBits - twos));
        EXPECT_EQ(best_ab_pair(wanted, kBits, kMaxPrescaler, Rational(64)).value(), *pair);
      }
    }
  }
  EXPECT_GT(exact, 100);
}

TEST(ExactAbPair, GivesTheFirstExactTubeOfSetup2) {
  const Rational wanted = ratio((Integer(1) << 32U) * 10'000, Integer(2 * 16) * 1800 * 940);
  EXPECT_EQ(exact_ab_pair(wanted, 32, 4'294'967'295U), (AbPair{.prescaler = 423, .increment = 335'544'320}));
  EXPECT_EQ(exact_ab_pair(wanted, 32, 422), std::nullopt);
}

TEST(ExactAbPair, CountsTheTubesOfSetup2) {
  // k = 16, np 1800..2100, nL 937..947, nenc 10000: how many of the 3311 close exactly at each interpolation.
  const int expected[] = {45, 21, 9, 0, 4, 0, 0, 0, 0};
  for (const int bits : {0, 1, 2, 4, 8}) {
    int exact = 0;
    for (std::int64_t slots = 1800; slots <= 2100; ++slots) {
      for (std::int64_t lines = 937; lines <= 947; ++lines) {
        const Rational wanted =
            ratio((Integer(10'000) << static_cast<unsigned>(32 + bits)), Integer(32) * slots * lines);
        exact += exact_ab_pair(wanted, 32, 4'294'967'295U) ? 1 : 0;
      }
    }
    EXPECT_EQ(exact, expected[bits]) << "q=" << bits;
  }
}

TEST(ExactFraction, IsTheWantedIncrement) {
  SCOPED_TRACE(seed_note());
  Random random;
  for (int trial = 0; trial < 2000; ++trial) {
    const int bits = static_cast<int>(random.between(8, 64));
    const std::uint64_t den = random.between(1, kMost64);
    const Rational wanted = ratio(Integer(random.between(1, largest_increment(bits))) * random.between(1, den), den);
    const auto fraction = exact_fraction(wanted, bits);
    ASSERT_TRUE(fraction) << fraction.error().message;
    const AbFraction& value = fraction.value();
    EXPECT_EQ(Rational(value.increment) + ratio(value.num, value.den), wanted);
    EXPECT_LT(value.num, value.den);
    EXPECT_LE(Integer(value.increment) + (value.num > 0 ? 1 : 0), Integer(largest_increment(bits)));
  }
}

TEST(ExactFraction, RefusesWhatDoesNotFit) {
  const auto denominator = exact_fraction(ratio(1, Integer(1) << 64U), 32);
  ASSERT_FALSE(denominator);
  EXPECT_EQ(denominator.error().code, ErrorCode::out_of_range);
  EXPECT_NE(denominator.error().message.find("18446744073709551616"), std::string::npos);
  const auto fast = exact_fraction(Rational(65), 8);
  ASSERT_FALSE(fast);
  EXPECT_EQ(fast.error().code, ErrorCode::out_of_range);
  EXPECT_NE(fast.error().message.find("2^(n-2) = 64"), std::string::npos);
}

}  // namespace
}  // namespace gravure
