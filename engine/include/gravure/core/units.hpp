#pragma once

#include <cstdint>

namespace gravure {

inline constexpr double kUmPerMm = 1000;
inline constexpr std::int64_t kMiB = std::int64_t{1} << 20;

}  // namespace gravure
