#pragma once

#include <cstddef>
#include <vector>

#include "gravure/core/contour.hpp"
#include "gravure/core/error.hpp"
#include "gravure/kinematics/joint.hpp"

namespace gravure::zones {

using kinematics::Vector3;

/// A contour, or a part of one that is too long for the scan field.
struct Piece {
  std::size_t contour = 0;  ///< its place in the list
  std::size_t part = 0;     ///< 0, 1 ... along the contour
  std::vector<Vector3> points_mm;
  Vector3 direction = Vector3::UnitZ();  ///< length 1
};

/// The contours, those that are larger than `field_mm` in the local frame of their own direction cut into as few parts
/// as fit it, of equal length as far as such fit: the cut is a point of both parts, and no length is lost. out_of_range
/// where field_mm is below 1 um, or so small that more than 10,000 parts come of it, and for more contours than that;
/// bad_argument for a contour without points or direction.
Result<std::vector<Piece>> cut_to_field(const std::vector<Contour>& contours, double field_mm);

/// The points of a contour, as vectors.
std::vector<Vector3> points_of(const Contour& contour);

/// Length of a line of points.
double length_mm(const std::vector<Vector3>& points) noexcept;

}  // namespace gravure::zones
