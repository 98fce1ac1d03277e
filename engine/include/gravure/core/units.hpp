#pragma once

#include <cstdint>

namespace gravure {

inline constexpr double kUmPerMm = 1000;
inline constexpr std::int64_t kMiB = std::int64_t{1} << 20;

/// Rounded up: what a refusal says is needed.
constexpr std::int64_t whole_mib(std::int64_t bytes) noexcept {
  return (bytes + kMiB - 1) / kMiB;
}

}  // namespace gravure
