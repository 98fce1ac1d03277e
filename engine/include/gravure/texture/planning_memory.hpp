#pragma once

#include <cstddef>
#include <cstdint>

#include "gravure/core/error.hpp"

namespace gravure::texture {

/// What planning a path of so many points holds at its peak, bytes: points on the surface, axes, runs and their splines
/// grow with the points; motion is made block by block and costs nothing more however long it takes. Measured, and
/// rounded up (docs/texture.md).
std::int64_t planning_bytes(std::size_t points) noexcept;

/// out_of_range where planning_bytes() is above `most_bytes`, naming both and the points that would do. 0: no limit.
Result<void> check_planning_memory(std::size_t points, std::int64_t most_bytes);

}  // namespace gravure::texture
