#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "gravure/core/path_motion.hpp"
#include "gravure/core/progress.hpp"

namespace gravure::texture {

/// Calls look(four, instant) for every period of a motion: the set-points one before its begin, at its begin, at its
/// end and one after; at both ends of the motion the outermost is repeated. `instant` is that of its begin. Errors as
/// PathMotion::read(); cancelled, saying what for, on request.
template <class Look>
Result<void> for_each_window(const PathMotion& motion, const CancelToken& cancel, const char* what, Look&& look) {
  constexpr std::int64_t kBlock = 16'384;
  const std::int64_t instants = motion.instants();
  std::vector<PathInstant> block(3);  // the last three of the block before stand in front
  for (std::int64_t first = 0; first < instants; first += kBlock) {
    if (cancel.cancelled()) {
      return Error{ErrorCode::cancelled, what};
    }
    const std::int64_t size = std::min(kBlock, instants - first);
    block.resize(3 + static_cast<std::size_t>(size));
    GRAVURE_CHECK(motion.read(first, std::span(block).subspan(3)));
    std::size_t from = 0;
    if (first == 0) {
      block[2] = block[3];
      from = 2;
    }
    if (first + size == instants) {
      block.push_back(block.back());
    }
    for (std::size_t k = from; k + 3 < block.size(); ++k) {
      look(std::span<const PathInstant, 4>(block.data() + k, 4), first + static_cast<std::int64_t>(k) - 2);
    }
    std::copy(block.end() - 3, block.end(), block.begin());
  }
  return {};
}

}  // namespace gravure::texture
