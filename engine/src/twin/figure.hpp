#pragma once

#include <cstdio>
#include <string>

namespace gravure {

/// Six significant digits, however small the value is.
inline std::string figure(double value) {
  char text[32];
  static_cast<void>(std::snprintf(text, sizeof text, "%.6g", value));
  return text;
}

}  // namespace gravure
