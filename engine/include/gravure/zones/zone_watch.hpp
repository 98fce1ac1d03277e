#pragma once

#include <cstddef>
#include <cstdint>

#include "gravure/core/error.hpp"
#include "gravure/core/progress.hpp"

namespace gravure::zones {

/// What a plan is made of, in this order.
enum class ZonePart : std::uint8_t { candidates, bound, windows, cover, k_means, refine, travel, tour, count };

/// Whether a plan that takes seconds is to go on, and who is told how far it is. Neither changes what comes out.
struct ZoneWatch {
  const CancelToken* cancel = nullptr;
  Progress* progress = nullptr;

  bool stopped() const noexcept { return cancel != nullptr && cancel->cancelled(); }
  /// `done` of `total` of a part are done.
  void tell(ZonePart part, std::size_t done, std::size_t total) const;
  /// Fails with cancelled where the plan is to stop: what was found until then is not whole.
  Result<void> go_on() const;
};

}  // namespace gravure::zones
