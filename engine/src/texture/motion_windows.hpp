#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "gravure/core/path_motion.hpp"
#include "gravure/core/progress.hpp"

namespace gravure::texture {

/// The periods from set-point `first` to set-point `last`.
struct Periods {
  std::int64_t first = 0;
  std::int64_t last = 0;
};

/// Calls look(block, begin) for blocks of set-points that overlap by three: block[k] to block[k + 3] are those round
/// the period that begins at instant begin + k, the one before its begin, at its begin, at its end and one after; at
/// both ends of the motion the outermost is repeated. Errors as PathMotion::read(); cancelled, saying what for, on
/// request.
template <class Look>
Result<void> for_each_block(const PathMotion& motion, const Periods& periods, const CancelToken& cancel,
                            const char* what, Look&& look) {
  constexpr std::int64_t kBlock = 4096;
  const std::int64_t last_instant = motion.instants() - 1;
  std::vector<PathInstant> block;
  for (std::int64_t begin = periods.first; begin < periods.last; begin += kBlock) {
    if (cancel.cancelled()) {
      return Error{ErrorCode::cancelled, what};
    }
    const std::int64_t end = std::min(begin + kBlock, periods.last);
    const std::int64_t from = std::max<std::int64_t>(begin - 1, 0);
    const std::int64_t to = std::min(end + 1, last_instant);
    const std::size_t front = begin == 0 ? 1 : 0;
    block.resize(front + static_cast<std::size_t>(to - from + 1));
    GRAVURE_CHECK(motion.read(from, std::span(block).subspan(front)));
    if (front == 1) {
      block[0] = block[1];
    }
    if (end == last_instant) {
      block.push_back(block.back());
    }
    look(std::span<const PathInstant>(block), begin);
  }
  return {};
}

/// The same, window by window: look(four, instant of the period's begin).
template <class Look>
Result<void> for_each_window(const PathMotion& motion, const CancelToken& cancel, const char* what, Look&& look) {
  return for_each_block(motion, {0, motion.instants() - 1}, cancel, what,
                        [&look](std::span<const PathInstant> block, std::int64_t begin) {
                          for (std::size_t k = 0; k + 3 < block.size(); ++k) {
                            look(std::span<const PathInstant, 4>(block.data() + k, 4),
                                 begin + static_cast<std::int64_t>(k));
                          }
                        });
}

}  // namespace gravure::texture
