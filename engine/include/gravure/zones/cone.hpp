#pragma once

#include <span>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/kinematics/joint.hpp"

namespace gravure::zones {

using kinematics::Vector3;

/// Angle between two directions, exact near 0 as well: atan2(|a x b|, a . b).
double angle_between(const Vector3& a, const Vector3& b) noexcept;

/// Directions within `half_angle_rad` of an axis.
struct Cone {
  Vector3 axis = Vector3::UnitZ();
  double half_angle_rad = 0;
};

/// The smallest cone that holds all directions (of length 1). It is the smallest circle on the sphere, and stands on
/// the two or three of them that no smaller one holds. Fails with out_of_range where no cone below 90 degrees does,
/// with bad_argument for no direction.
Result<Cone> enclosing_cone(std::span<const Vector3> directions);

/// Largest angle between an axis and any of the directions.
double largest_angle_from(const Vector3& axis, std::span<const Vector3> directions) noexcept;

/// Largest angle between any two of the directions.
double largest_angle(std::span<const Vector3> directions) noexcept;

}  // namespace gravure::zones
