#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "gravure/core/program.hpp"

namespace gravure {

/// The set-points of a program one by one, read in blocks: cheapest where the next is near the last.
class SetPointWalk {
 public:
  explicit SetPointWalk(LineSource& program) : program_(program), total_(set_points_of(program.header().plan)) {}
  std::int64_t total() const noexcept { return total_; }
  /// Set-point `index`; before the first the first, behind the last the last. Errors as LineSource::read_set_points().
  Result<PathSetPoint> at(std::int64_t index) {
    constexpr std::int64_t kBlock = 8192;
    constexpr std::int64_t kBack = 1024;  // so far back goes without reading anew
    index = std::clamp<std::int64_t>(index, 0, total_ - 1);
    if (index < first_ || index >= first_ + static_cast<std::int64_t>(block_.size())) {
      first_ = std::max<std::int64_t>(0, index - kBack);
      block_.resize(static_cast<std::size_t>(std::min(kBlock, total_ - first_)));
      GRAVURE_CHECK(program_.read_set_points(first_, block_));
    }
    return block_[static_cast<std::size_t>(index - first_)];
  }

 private:
  LineSource& program_;
  std::int64_t total_;
  std::int64_t first_ = 0;
  std::vector<PathSetPoint> block_;
};

}  // namespace gravure
