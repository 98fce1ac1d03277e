#pragma once

#include <fmt/format.h>

#include <cmath>

#include "gravure/core/error.hpp"

namespace gravure::zones {

inline Result<void> check_positive(const char* name, double value) {
  if (!(value > 0) || !std::isfinite(value)) {
    return Error{ErrorCode::out_of_range, fmt::format("{} = {}: must be greater than 0", name, value)};
  }
  return {};
}

}  // namespace gravure::zones
