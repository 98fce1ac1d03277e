#pragma once

#include <cstdint>
#include <string_view>

#include "gravure/core/plan.hpp"

namespace gravure::plan_json {

struct ModeName {
  Mode mode;
  std::string_view name;
};
inline constexpr ModeName kModeNames[] = {{Mode::rotary, "rotary"},
                                          {Mode::helical, "helical"},
                                          {Mode::flat, "flat"},
                                          {Mode::freeform, "freeform"},
                                          {Mode::zones, "zones"}};

/// 2^53: up to it every integer is a double, so every JSON reader keeps it.
inline constexpr std::int64_t kLargestJsonInteger = std::int64_t{1} << 53;

/// The readable form of a ratio is a whole number (else a double).
inline bool plain_is_whole(const Rational& value) {
  return denominator_of(value) == 1 && abs(numerator_of(value)) <= kLargestJsonInteger;
}

}  // namespace gravure::plan_json
