#include "gravure/texture/axis_limits.hpp"

#include <fmt/format.h>

#include <cmath>

namespace gravure::texture {

using kinematics::Vector3;

AxesLimits published_limits() {
  // The jerk that reaches the acceleration in 10 ms on stages, in 20 ms on the galvo.
  const auto stage = [](double speed, double acceleration) {
    return AxisBounds{speed, acceleration, acceleration * 100};
  };
  const AxisBounds galvo{2000, 20'000, 1'000'000};
  return {stage(100, 100), stage(100, 100), stage(100, 50), stage(1, 1.994), stage(6, 3.734), galvo, galvo};
}

Result<void> check_limits(const AxesLimits& limits) {
  if (limits.size() != kFocusAxis && limits.size() != kPathAxes.size()) {
    return Error{ErrorCode::bad_argument, fmt::format("limits of {} axes: must be {}, or {} with a focus axis",
                                                      limits.size(), kFocusAxis, kPathAxes.size())};
  }
  for (std::size_t k = 0; k < limits.size(); ++k) {
    for (const double each : {limits[k].speed, limits[k].acceleration, limits[k].jerk}) {
      if (!(each > 0) || !std::isfinite(each)) {
        return Error{ErrorCode::out_of_range,
                     fmt::format("axis {}: speed {}, acceleration {} and jerk {} must all be above 0", kPathAxes[k],
                                 limits[k].speed, limits[k].acceleration, limits[k].jerk)};
      }
    }
  }
  return {};
}

Result<AxesLimits> limits_of(const kinematics::Machine& machine, const AxesLimits& otherwise) {
  GRAVURE_CHECK(check_limits(otherwise));
  AxesLimits limits = otherwise;
  constexpr std::size_t kStages = 5;
  for (std::size_t k = 0; k < kStages; ++k) {
    GRAVURE_TRY(const std::size_t at, kinematics::find_joint(machine, kPathAxes[k]));
    const kinematics::JointLimits& joint = machine.joints[at].limits;
    limits[k] = {joint.max_speed.value_or(limits[k].speed), joint.max_acceleration.value_or(limits[k].acceleration),
                 joint.max_jerk.value_or(limits[k].jerk)};
  }
  for (std::size_t k = kStages; k < kFocusAxis; ++k) {
    limits[k] = {machine.head.max_speed_mm_s.value_or(limits[k].speed),
                 machine.head.max_acceleration_mm_s2.value_or(limits[k].acceleration),
                 machine.head.max_jerk_mm_s3.value_or(limits[k].jerk)};
  }
  GRAVURE_CHECK(check_limits(limits));
  return limits;
}

Vector3 RotaryTable::turned(double a_rad, double c_rad, const Vector3& p) const noexcept {
  const Vector3 from = p - centre_mm;
  const double c = std::cos(c_rad);
  const double s = sense * std::sin(c_rad);
  const double ca = std::cos(a_rad);
  const double sa = sense * std::sin(a_rad);
  const double y = s * from.x() + c * from.y();
  return {c * from.x() - s * from.y(), sense * (ca * y - sa * from.z()), sa * y + ca * from.z()};
}

Vector3 RotaryTable::beam(double a_rad, double c_rad) const noexcept {
  const double sa = sense * std::sin(a_rad);
  return {sa * sense * std::sin(c_rad), sa * std::cos(c_rad), std::cos(a_rad)};
}

Result<RotaryTable> rotary_table(const kinematics::Machine& machine) {
  constexpr double kSame = 1e-12;
  const auto is = [&machine](std::size_t k, const Vector3& axis) {
    return k < machine.joints.size() && machine.joints[k].name == kPathAxes[k] &&
           (machine.joints[k].axis - axis).norm() < kSame;
  };
  const double sense = machine.joints.size() == 5 && machine.joints[3].axis.x() < 0 ? -1 : 1;
  const bool stages = machine.joints.size() == 5 && is(0, Vector3::UnitX()) && is(1, sense * Vector3::UnitY()) &&
                      is(2, Vector3::UnitZ()) && is(3, sense * Vector3::UnitX()) && is(4, sense * Vector3::UnitZ());
  const kinematics::ScanHead& head = machine.head;
  const bool lens = head.lens == kinematics::Lens::telecentric && (head.u_axis - Vector3::UnitX()).norm() < kSame &&
                    (head.v_axis - sense * Vector3::UnitY()).norm() < kSame &&
                    (head.beam_axis - Vector3::UnitZ()).norm() < kSame;
  if (!stages || !lens || (machine.joints[3].origin_mm - head.origin_mm).norm() > kSame ||
      (machine.joints[4].origin_mm - head.origin_mm).norm() > kSame) {
    return Error{
        ErrorCode::bad_argument,
        fmt::format("machine '{}': motion along a path needs joints X, Y and Z under a head with a telecentric "
                    "lens, and A and C under the workpiece that meet where X, Y and Z count from",
                    machine.title)};
  }
  return RotaryTable{sense, head.origin_mm};
}

}  // namespace gravure::texture
