#pragma once

#include <span>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/texture/split.hpp"

namespace gravure::texture {

/// Strokes of a drawing one after another, the straight ways between them dark, as a whole centred on the origin by its
/// bounding box. Points lie `step_mm` apart or as near to it as divides a stroke or a way; both ends are points.
/// bad_argument for no stroke, strokes of fewer than two points, and as resample().
Result<TexturePath> stroke_path(std::span<const std::vector<Vector2>> strokes_mm, double step_mm,
                                std::size_t most_points);

}  // namespace gravure::texture
