#pragma once

#include <Eigen/Core>

#include "gravure/core/error.hpp"
#include "gravure/kinematics/joint.hpp"

namespace gravure::zones {

using kinematics::Vector3;

/// A right-handed frame on the part, z towards the head.
struct LocalFrame {
  Vector3 x = Vector3::UnitX();
  Vector3 y = Vector3::UnitY();
  Vector3 z = Vector3::UnitZ();
  Vector3 origin_mm = Vector3::Zero();

  Vector3 to_local(const Vector3& part_mm) const noexcept;
  Vector3 to_part(const Vector3& local_mm) const noexcept;
  /// H = [R^T, -R^T o; 0 1]: part to local.
  Eigen::Matrix4d matrix() const noexcept;
};

/// z = direction / |direction|, y = the part of the workpiece's z at right angles to it, x = y x z. [D] eq. 12 has x =
/// z x y, which is left-handed and mirrors the galvo's data, and takes the centre of a cluster for z as it is, shorter
/// than 1. Where z is the workpiece's z, y comes from its y. out_of_range for a direction of no length.
Result<LocalFrame> local_frame(const Vector3& direction, const Vector3& origin_mm);

}  // namespace gravure::zones
