#include "gravure/core/exact.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

namespace gravure {
namespace {

constexpr int kMaxExponent = 400;  // decimal; far beyond any physical quantity, small enough to stay cheap
constexpr std::size_t kMaxDigits = 400;

Integer power_of_ten(int exponent) {
  return boost::multiprecision::pow(Integer(10), static_cast<unsigned>(exponent));
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

Error not_decimal(std::string_view text) {
  return {ErrorCode::bad_argument, "\"" + std::string(text.substr(0, 60)) + "\" is not a decimal number"};
}

}  // namespace

Rational ratio(const Integer& num, const Integer& den) {
  // Boost 1.74 refuses negative denominators of unbounded integers with an exception.
  return den < 0 ? Rational(Integer(-num), Integer(-den)) : Rational(num, den);
}

Integer floor_of(const Rational& value) {
  Integer quotient;
  Integer remainder;
  divide_qr(numerator_of(value), denominator_of(value), quotient, remainder);
  return remainder < 0 ? Integer(quotient - 1) : quotient;
}

Integer ceil_of(const Rational& value) {
  return Integer(-floor_of(Rational(-value)));
}

Integer round_of(const Rational& value) {
  const Rational half(1, 2);
  return value < 0 ? ceil_of(Rational(value - half)) : floor_of(Rational(value + half));
}

double to_double(const Integer& value) {
  if (value == 0) {
    return 0.0;
  }
  // 64 leading bits, the last one sticky: rounding them to 53 is then rounding the whole number.
  const bool negative = value < 0;
  const Integer magnitude = negative ? Integer(-value) : value;
  const auto top = static_cast<long>(msb(magnitude));
  const long shift = top > 63 ? top - 63 : 0;
  auto leading = static_cast<std::uint64_t>(Integer(magnitude >> static_cast<unsigned long>(shift)));
  if (shift > 0 && static_cast<long>(lsb(magnitude)) < shift) {
    leading |= 1U;
  }
  const double result = std::ldexp(static_cast<double>(leading), static_cast<int>(shift));
  return negative ? -result : result;
}

namespace {

/// num/den below about 2^min_exponent: rounded once, to a whole number of the smallest steps a double has.
double subnormal(const Integer& num, const Integer& den) {
  constexpr int kSmallestStep = std::numeric_limits<double>::min_exponent - std::numeric_limits<double>::digits;
  Integer steps;
  Integer remainder;
  divide_qr(Integer(num << static_cast<unsigned>(-kSmallestStep)), den, steps, remainder);
  const Integer twice = 2 * remainder;
  if (twice > den || (twice == den && bit_test(steps, 0))) {
    ++steps;
  }
  return std::ldexp(static_cast<double>(static_cast<std::uint64_t>(steps)), kSmallestStep);
}

}  // namespace

double to_double(const Rational& value) {
  const Integer num = abs(numerator_of(value));
  if (num == 0) {
    return 0.0;
  }
  const Integer den = denominator_of(value);
  const long exponent = static_cast<long>(msb(num)) - static_cast<long>(msb(den));
  if (exponent < std::numeric_limits<double>::min_exponent) {
    return value < 0 ? -subnormal(num, den) : subnormal(num, den);
  }
  // Scale so that the quotient has at least 64 significant bits, divide exactly, keep a sticky bit.
  const long scale = 66 - exponent;
  const Integer scaled_num = scale > 0 ? Integer(num << static_cast<unsigned long>(scale)) : num;
  const Integer scaled_den = scale < 0 ? Integer(den << static_cast<unsigned long>(-scale)) : den;
  Integer quotient;
  Integer remainder;
  divide_qr(scaled_num, scaled_den, quotient, remainder);
  if (remainder != 0) {
    quotient = (quotient << 1) | 1;
  } else {
    quotient <<= 1;
  }
  const double result = std::ldexp(to_double(quotient), static_cast<int>(-scale - 1));
  return value < 0 ? -result : result;
}

std::string to_string(const Integer& value) {
  return value.str();
}

std::string to_string(const Rational& value) {
  const Integer den = denominator_of(value);
  return den == 1 ? numerator_of(value).str() : numerator_of(value).str() + "/" + den.str();
}

bool fits_int64(const Integer& value) {
  return value >= std::numeric_limits<std::int64_t>::min() && value <= std::numeric_limits<std::int64_t>::max();
}

bool fits_uint64(const Integer& value) {
  return value >= 0 && value <= std::numeric_limits<std::uint64_t>::max();
}

Result<std::int64_t> to_int64(const Integer& value, std::string_view field) {
  if (!fits_int64(value)) {
    return Error{ErrorCode::out_of_range, std::string(field) + " = " + value.str() + ": beyond 64-bit integers"};
  }
  return static_cast<std::int64_t>(value);
}

Result<std::uint64_t> to_uint64(const Integer& value, std::string_view field) {
  if (!fits_uint64(value)) {
    return Error{ErrorCode::out_of_range,
                 std::string(field) + " = " + value.str() + ": beyond unsigned 64-bit integers"};
  }
  return static_cast<std::uint64_t>(value);
}

Result<Rational> parse_decimal(std::string_view text) {
  std::size_t at = 0;
  const auto peek = [&] { return at < text.size() ? text[at] : '\0'; };
  bool negative = false;
  if (peek() == '+' || peek() == '-') {
    negative = text[at++] == '-';
  }
  std::string digits;
  int exponent = 0;
  // TOML lets underscores stand between digits, nowhere else.
  const auto take_digits = [&](std::string& into) {
    const std::size_t before = into.size();
    while (is_digit(peek()) ||
           (peek() == '_' && at > 0 && is_digit(text[at - 1]) && at + 1 < text.size() && is_digit(text[at + 1]))) {
      if (text[at] != '_') {
        into.push_back(text[at]);
      }
      ++at;
    }
    return into.size() - before;
  };
  if (take_digits(digits) == 0) {
    return not_decimal(text);
  }
  if (peek() == '.') {
    ++at;
    const std::size_t fraction_digits = take_digits(digits);
    if (fraction_digits == 0 || fraction_digits > kMaxDigits) {
      return not_decimal(text);
    }
    exponent = -static_cast<int>(fraction_digits);
  }
  if (peek() == 'e' || peek() == 'E') {
    ++at;
    bool exponent_negative = false;
    if (peek() == '+' || peek() == '-') {
      exponent_negative = text[at++] == '-';
    }
    std::string exponent_digits;
    if (take_digits(exponent_digits) == 0 || exponent_digits.size() > 4) {
      return not_decimal(text);
    }
    const int given = std::atoi(exponent_digits.c_str());
    if (given > kMaxExponent) {
      return not_decimal(text);
    }
    exponent += exponent_negative ? -given : given;
  }
  if (at != text.size() || digits.size() > kMaxDigits) {
    return not_decimal(text);
  }
  // A leading 0 would make the digits octal.
  const std::size_t first = digits.find_first_not_of('0');
  const Integer mantissa = first == std::string::npos ? Integer(0) : Integer(digits.substr(first));
  const Rational value = exponent >= 0 ? Rational(Integer(mantissa * power_of_ten(exponent)))
                                       : Rational(mantissa, power_of_ten(-exponent));
  return negative ? Rational(-value) : value;
}

std::string to_decimal_string(const Rational& value) {
  constexpr int kDigitsAfterPoint = 40;
  Integer den = denominator_of(value);
  int digits = 0;
  Integer scale = 1;
  while (scale % den != 0) {
    if (++digits > kDigitsAfterPoint) {
      return to_string(value);
    }
    scale *= 10;
  }
  const Integer scaled = numerator_of(value) * (scale / den);
  std::string text = Integer(abs(scaled)).str();
  if (digits > 0) {
    const auto places = static_cast<std::size_t>(digits);
    if (text.size() <= places) {
      text.insert(0, places + 1 - text.size(), '0');
    }
    text.insert(text.size() - places, 1, '.');
  }
  return scaled < 0 ? "-" + text : text;
}

const Rational& pi() {
  static const Rational value(Integer("31415926535897932384626433832795028841971693993751"
                                      "058209749445923078164062862089986280348253421170680"),
                              power_of_ten(100));
  return value;
}

}  // namespace gravure
