#include "gravure/sync/ab_ratio.hpp"

#include <algorithm>
#include <string>

#include "text.hpp"

namespace gravure {

using namespace sync_plan;

namespace {

constexpr int kLeastBits = 2;
constexpr int kMostBits = 64;

/// A fraction num/den of the Stern-Brocot tree and how far it lies from X = a/b: distance = |a den - b num|.
struct Neighbour {
  Integer num;
  Integer den;
  Integer distance;
};

/// How often `step` can be added to `from` before a side of the box is passed.
Integer room(const Neighbour& from, const Neighbour& step, const Integer& most_num, const Integer& most_den) {
  // One of the two is above 0: the tree starts at 0/1 and 1/0.
  if (step.num == 0) {
    return (most_den - from.den) / step.den;
  }
  if (step.den == 0) {
    return (most_num - from.num) / step.num;
  }
  return std::min(Integer((most_num - from.num) / step.num), Integer((most_den - from.den) / step.den));
}

/// Moves `from` towards X by the mediants with `step` that do not pass X and stay in the box. False: none does.
bool advance(Neighbour& from, const Neighbour& step, const Integer& most_num, const Integer& most_den) {
  const Integer times = std::min(Integer(from.distance / step.distance), room(from, step, most_num, most_den));
  if (times == 0) {
    return false;
  }
  from.num += times * step.num;
  from.den += times * step.den;
  from.distance -= times * step.distance;
  return true;
}

AbPair to_pair(const Neighbour& fraction) {
  return {.prescaler = static_cast<std::uint64_t>(fraction.den), .increment = static_cast<std::uint64_t>(fraction.num)};
}

bool below_fits(const Neighbour& below) {
  return below.num > 0;
}

bool above_fits(const Neighbour& above, const Rational& max_increment) {
  return above.den > 0 && above.num * denominator_of(max_increment) <= numerator_of(max_increment) * above.den;
}

Result<void> check_counter(const Rational& wanted_increment, int counter_bits) {
  if (counter_bits < kLeastBits || counter_bits > kMostBits) {
    return Error{ErrorCode::out_of_range, "counter_bits = " + std::to_string(counter_bits) + ": must be " +
                                              std::to_string(kLeastBits) + " to " + std::to_string(kMostBits)};
  }
  if (wanted_increment <= 0) {
    return Error{ErrorCode::out_of_range,
                 "wanted increment = " + number_text(wanted_increment) + " counts per clock: must be greater than 0"};
  }
  if (wanted_increment > Rational(largest_increment(counter_bits))) {
    return Error{ErrorCode::out_of_range,
                 "wanted increment = " + number_text(wanted_increment) +
                     " counts per clock: at most 2^(n-2) = " + std::to_string(largest_increment(counter_bits)) +
                     " fits a counter of n = " + std::to_string(counter_bits) +
                     " bits, or A and B would change together; ask for a lower frequency"};
  }
  return {};
}

}  // namespace

std::uint64_t largest_increment(int counter_bits) noexcept {
  return std::uint64_t{1} << static_cast<unsigned>(counter_bits - 2);
}

Rational increment_per_clock(const Rational& ab_hz, int counter_bits, const Rational& fpga_hz) {
  return ab_hz * Rational(Integer(1) << static_cast<unsigned>(counter_bits)) / fpga_hz;
}

Result<AbPair> best_ab_pair(const Rational& wanted_increment, int counter_bits, std::uint64_t max_prescaler,
                            const Rational& max_increment) {
  GRAVURE_CHECK(check_counter(wanted_increment, counter_bits));
  if (max_prescaler == 0) {
    return Error{ErrorCode::out_of_range, "max_prescaler = 0: must be at least 1"};
  }
  if (wanted_increment > max_increment) {
    return Error{ErrorCode::out_of_range, "wanted increment = " + number_text(wanted_increment) +
                                              " counts per clock: the highest allowed frequency leaves at most " +
                                              number_text(max_increment) + "; ask for a lower frequency"};
  }
  const Integer most_num = largest_increment(counter_bits);
  const Integer most_den = max_prescaler;
  Neighbour below{0, 1, numerator_of(wanted_increment)};
  Neighbour above{1, 0, denominator_of(wanted_increment)};
  bool moved = true;
  while (moved && below.distance != 0 && above.distance != 0) {
    moved = advance(below, above, most_num, most_den);
    if (below.distance != 0) {
      moved = advance(above, below, most_num, most_den) || moved;
    }
  }
  const bool use_below = below_fits(below);
  const bool use_above = above_fits(above, max_increment);
  if (use_below && use_above) {
    // Distances of the fractions themselves are distance / (b den); on equality the smaller m wins.
    const Integer left = below.distance * above.den;
    const Integer right = above.distance * below.den;
    const bool closer_below = left < right || (left == right && below.den <= above.den);
    return to_pair(closer_below ? below : above);
  }
  if (!use_below && !use_above) {
    return Error{ErrorCode::out_of_range, "max_prescaler = " + std::to_string(max_prescaler) +
                                              ": even 1 count every that many clocks is above the highest allowed " +
                                              number_text(max_increment) + " counts per clock; at least " +
                                              to_string(ceil_of(Rational(1 / max_increment))) + " would fit"};
  }
  return to_pair(use_below ? below : above);
}

std::optional<AbPair> exact_ab_pair(const Rational& wanted_increment, int counter_bits, std::uint64_t max_prescaler) {
  // In lowest terms X is already a 2^(n-t) / (b/2^t): the bounds on both are the criterion.
  const Integer increment = numerator_of(wanted_increment);
  const Integer prescaler = denominator_of(wanted_increment);
  if (increment <= 0 || increment > largest_increment(counter_bits) || prescaler > max_prescaler) {
    return std::nullopt;
  }
  return AbPair{.prescaler = static_cast<std::uint64_t>(prescaler), .increment = static_cast<std::uint64_t>(increment)};
}

Result<AbFraction> exact_fraction(const Rational& wanted_increment, int counter_bits) {
  GRAVURE_CHECK(check_counter(wanted_increment, counter_bits));
  const Integer increment = floor_of(wanted_increment);
  const Rational rest = wanted_increment - Rational(increment);
  if (!fits_uint64(denominator_of(rest))) {
    return Error{ErrorCode::out_of_range,
                 "fraction denominator = " + to_string(denominator_of(rest)) +
                     ": at most 2^64 - 1 fits the second accumulator; a shorter line, fewer lines per revolution or a "
                     "simpler gear ratio makes it smaller"};
  }
  return AbFraction{.increment = static_cast<std::uint64_t>(increment),
                    .num = static_cast<std::uint64_t>(numerator_of(rest)),
                    .den = static_cast<std::uint64_t>(denominator_of(rest))};
}

}  // namespace gravure
