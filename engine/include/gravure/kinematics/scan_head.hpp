#pragma once

#include <cstdint>
#include <optional>

#include "gravure/core/error.hpp"
#include "gravure/core/exact.hpp"
#include "gravure/kinematics/joint.hpp"

namespace gravure::kinematics {

enum class Lens : std::uint8_t {
  telecentric,  ///< the beam is parallel to the lens axis everywhere in the field
  f_theta,      ///< the beam tilts outwards, in proportion to the distance from the centre of the field
};

/// A point of the beam as the head sees it: the field coordinates of the beam and the distance from its focus towards
/// the head. A surface point at w_mm = 0 is in focus.
struct FieldPoint {
  double u_mm = 0;
  double v_mm = 0;
  double w_mm = 0;
};

/// A galvo scanner with its lens. The directions are in the machine's frame with every joint at 0; u, v and beam are at
/// right angles and may be left-handed (a mirrored v axis, as [A] has it).
struct ScanHead {
  Vector3 origin_mm = Vector3::Zero();  ///< focus at U = V = 0
  Vector3 u_axis = Vector3::UnitX();
  Vector3 v_axis = Vector3::UnitY();
  Vector3 beam_axis = Vector3::UnitZ();  ///< along the lens axis, towards the head
  Lens lens = Lens::telecentric;
  double tilt_rad_per_mm = 0;            ///< f_theta: tilt of the beam a mm of distance from the centre
  double field_mm = 0;                   ///< side of the square field: -field/2 to field/2 in U and V
  int resolution_bits = 16;              ///< set-points are integers of so many bits over the field
  Rational lag_us = 0;                   ///< the mirrors follow their set-points so much later
  std::optional<double> max_speed_mm_s;  ///< of U and of V alone; absent limits are not checked
  std::optional<double> max_acceleration_mm_s2;
  std::optional<double> max_jerk_mm_s3;
};

/// From a point of the workpiece to the head, in the head's own axes (u, v, beam): length 1.
Vector3 beam_of(const ScanHead& head, const FieldPoint& field);

/// The field point whose beam passes through a point given in the head's own axes; closed form for telecentric lenses,
/// Newton in one unknown for f-theta lenses. Fails with out_of_range where no beam does.
Result<FieldPoint> field_of_point(const ScanHead& head, const Vector3& point_mm);

/// Fails with out_of_range where U or V lies beyond the field, naming the field that would do.
Result<void> check_field(const ScanHead& head, const FieldPoint& field);

}  // namespace gravure::kinematics
