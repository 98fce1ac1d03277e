#include "text.hpp"

#include <array>
#include <cstdio>

namespace gravure::sync_plan {

std::string number_text(const Rational& value) {
  constexpr std::size_t kShort = 20;
  if (denominator_of(value) == 1) {
    return to_string(numerator_of(value));
  }
  std::string exact = to_decimal_string(value);
  if (exact.size() <= kShort && exact.find('/') == std::string::npos) {
    return exact;
  }
  std::array<char, 40> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), "%.9g", to_double(value));
  return {buffer.data(), static_cast<std::size_t>(length)};
}

}  // namespace gravure::sync_plan
