#pragma once

#include <cstdint>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/texture/surface.hpp"

namespace gravure::texture {

/// The Hilbert curve of an order as 4^order points, a side of the square apart `size_mm` in all, centred on the origin:
/// from (-size / 2, -size / 2) to (size / 2, -size / 2). out_of_range for orders but 1 to 12 or sizes that are not
/// above 0.
Result<std::vector<Vector2>> hilbert_curve(int order, double size_mm);

/// Arc length from the first point to each point.
std::vector<double> arc_lengths_mm(std::span<const Vector2> path_mm);

/// The path at every multiple of `step_mm` of its arc length, and at its end; straight between its points.
/// bad_argument for fewer than two points, a step that is not above 0, or more than `most_points` of them.
Result<std::vector<Vector2>> resample(std::span<const Vector2> path_mm, double step_mm, std::size_t most_points);

}  // namespace gravure::texture
