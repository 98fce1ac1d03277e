#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure {

/// One stroke of a drawing: x and y in mm, y upwards; curves and arcs as chords.
using SvgStroke = std::vector<std::array<double, 2>>;

/// The strokes of a drawing in SVG, in their order: `path`, `line`, `polyline`, `polygon`, `rect`, `circle` and
/// `ellipse` inside `svg` and `g` with their transforms, sizes and view boxes; a unit without a name is 1/96 inch. What
/// else there is (text, `use`, pictures, styles) is passed over. No chord leaves its curve by more than `tolerance_mm`.
///
/// bad_file for what is no SVG, has no stroke, or coordinates that are not finite or beyond 1e6 mm; out_of_range for a
/// tolerance that is not above 0 and for more than 50 million points. Nothing is fetched, entities of a file's own are
/// not expanded. `name` stands in messages.
Result<std::vector<SvgStroke>> parse_svg(std::string_view text, const std::string& name, double tolerance_mm);

}  // namespace gravure
