#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "gravure/core/path_motion.hpp"

namespace gravure::test {

/// A motion whose instants lie in memory.
class SampledMotion final : public PathMotion {
 public:
  explicit SampledMotion(std::vector<PathInstant> instants) : instants_(std::move(instants)) {}
  std::int64_t instants() const noexcept override { return static_cast<std::int64_t>(instants_.size()); }
  Result<void> read(std::int64_t first, std::span<PathInstant> out) const override {
    if (first < 0 || first + static_cast<std::int64_t>(out.size()) > instants()) {
      return Error{ErrorCode::bad_argument, "instants beyond the motion"};
    }
    std::copy_n(instants_.begin() + first, out.size(), out.begin());
    return {};
  }

 private:
  std::vector<PathInstant> instants_;
};

/// Pulses that all fire.
inline PathPulses all_pulses(double pitch_mm, std::int64_t count) {
  return {pitch_mm, count, std::vector<std::byte>(static_cast<std::size_t>((count + 7) / 8), std::byte{0xFF})};
}

}  // namespace gravure::test
