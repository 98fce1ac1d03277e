#pragma once

#include <cstdint>
#include <optional>

#include "gravure/core/error.hpp"
#include "gravure/core/exact.hpp"

namespace gravure {

/// What the A-B counter is programmed with: it adds `increment` on every `prescaler`-th FPGA clock.
struct AbPair {
  std::uint64_t prescaler = 1;  ///< m, at least 1
  std::uint64_t increment = 0;  ///< incr, 1 to largest_increment()

  friend bool operator==(const AbPair&, const AbPair&) = default;
};

/// What a counter with a second accumulator is programmed with: on every FPGA clock it adds `increment`, and 1 more on
/// `num` of every `den` clocks.
struct AbFraction {
  std::uint64_t increment = 0;
  std::uint64_t num = 0;  ///< less than den
  std::uint64_t den = 1;

  friend bool operator==(const AbFraction&, const AbFraction&) = default;
};

/// Largest increment of an n-bit counter, 2^(n-2): a larger one would let A and B change on one clock ([B] eq. 2).
/// counter_bits is 2 to 64.
std::uint64_t largest_increment(int counter_bits) noexcept;

/// Wanted counts per FPGA clock, X = incr/m of [B] eq. 6, for an A-B frequency of `ab_hz` from a clock of `fpga_hz`.
Rational increment_per_clock(const Rational& ab_hz, int counter_bits, const Rational& fpga_hz);

/// The pair whose incr/m is closest to `wanted_increment` (X > 0) among all with 1 <= incr <= 2^(n-2),
/// 1 <= m <= max_prescaler and incr/m <= max_increment. Ties go to the smaller m, then to the smaller increment.
///
/// Not a search: neighbours of X are built along the Stern-Brocot tree, one step for each partial quotient of the
/// continued fraction of X, the last quotient clipped to the box (semiconvergents). Between the final neighbours no
/// fraction of the box is left, so the closer one is the best; at most some hundred steps for 64-bit counters.
///
/// An X below 1/max_prescaler gets 1/max_prescaler. out_of_range when X is above 2^(n-2) or above max_increment, when
/// even 1/max_prescaler is above max_increment, or when an argument is outside its range (counter_bits 2 to 64, X
/// and max_prescaler above 0).
Result<AbPair> best_ab_pair(const Rational& wanted_increment, int counter_bits, std::uint64_t max_prescaler,
                            const Rational& max_increment);

/// The pair with the smallest m whose incr/m is exactly `wanted_increment`, if there is one.
///
/// With a/b the wanted A-B periods per clock in lowest terms (X = 2^n a/b) and t = min(n, number of twos in b), one
/// exists if and only if 4a <= 2^t and b/2^t <= max_prescaler; it is m = b/2^t, incr = a 2^(n-t). So more counter bits
/// never make a ratio exact that was not.
std::optional<AbPair> exact_ab_pair(const Rational& wanted_increment, int counter_bits, std::uint64_t max_prescaler);

/// `wanted_increment` (X > 0) as increment + num/den at a prescaler of 1: no drift whatever X is. out_of_range when X
/// is above 2^(n-2) or the denominator does not fit 64 bits.
Result<AbFraction> exact_fraction(const Rational& wanted_increment, int counter_bits);

}  // namespace gravure
