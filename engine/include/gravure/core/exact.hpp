#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <string>
#include <string_view>

#include "gravure/core/error.hpp"

namespace gravure {

/// Integers and ratios without bound or rounding: frequencies, ratios, drifts and times are these, never double.
/// Expression templates are off, so `auto` is always a value.
using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;
using Rational =
    boost::multiprecision::number<boost::multiprecision::rational_adaptor<boost::multiprecision::cpp_int_backend<>>,
                                  boost::multiprecision::et_off>;

inline Integer numerator_of(const Rational& value) {
  return boost::multiprecision::numerator(value);
}
inline Integer denominator_of(const Rational& value) {
  return boost::multiprecision::denominator(value);
}

/// num/den in lowest terms; den of either sign, not 0 (Boost 1.74's own constructor throws where it is negative).
Rational ratio(const Integer& num, const Integer& den);

Integer floor_of(const Rational& value);
Integer ceil_of(const Rational& value);
/// Nearest integer; halves go away from zero.
Integer round_of(const Rational& value);
/// Nearest double, even where numerator and denominator alone are beyond its range (for printing and geometry).
double to_double(const Rational& value);
/// Nearest double, infinity beyond its range.
double to_double(const Integer& value);
/// Decimal digits.
std::string to_string(const Integer& value);
/// "num/den", or "num" where den is 1.
std::string to_string(const Rational& value);
/// Fits std::int64_t / std::uint64_t?
bool fits_int64(const Integer& value);
bool fits_uint64(const Integer& value);
/// Fits, or out_of_range naming `field`.
Result<std::int64_t> to_int64(const Integer& value, std::string_view field);
Result<std::uint64_t> to_uint64(const Integer& value, std::string_view field);

/// The exact value of a decimal literal as TOML writes it: "70", "-0.35", "8.0", "1_000.5e-3".
/// Exponents beyond +-400 and anything else (inf, nan, hex) are bad_argument.
Result<Rational> parse_decimal(std::string_view text);
/// The shortest exact decimal text when the value has one of at most 40 digits after the point, else "num/den".
std::string to_decimal_string(const Rational& value);

/// pi to 100 decimals. As a ratio its error is below 1e-100, far under anything an integer decision here depends on.
const Rational& pi();

}  // namespace gravure
