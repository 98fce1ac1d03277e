#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "gravure/motion/ruled_blade.hpp"

namespace gravure::motion {

/// A smooth curve through the points, 2 or more (Catmull-Rom): it is at point k for the parameter k.
Curve curve_through(std::vector<Vector3> points);

/// The two curves a blade is ruled between, by points; row k of both belongs to one ruling.
struct BladeRails {
  std::vector<Vector3> shroud;
  std::vector<Vector3> hub;
};

/// Six columns: x, y, z of the shroud curve and x, y, z of the hub curve in mm, in the form of parse_recording_csv().
/// bad_file where there are fewer than 2 rows.
Result<BladeRails> parse_blade_csv(std::string_view text);

/// How the blades of an impeller stand, and how finely they are sampled.
struct BladeSampling {
  double thickness_mm = 0;  ///< 0 to 1e4
  std::size_t blades = 1;   ///< evenly about an axis along z, 1 to 1000
  Vector3 centre_mm{};      ///< a point of that axis
  double spacing_mm = 0.5;  ///< 1e-3 to 1e4: neighbours on a side are no further apart
};

/// Both sides of every blade ([C2] eqs 1 to 3). A point of the sides lies within spacing / sqrt(2) of a sample.
/// Fails with out_of_range for values outside their ranges, coordinates beyond 1e6 mm, and where more than 5 million
/// points would be needed.
Result<std::vector<Vector3>> blade_points(const BladeRails& rails, const BladeSampling& sampling);

}  // namespace gravure::motion
