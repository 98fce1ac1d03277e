#include "gravure/texture/axes.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "gravure/texture/axis_limits.hpp"

namespace gravure::texture {
namespace {

constexpr double kPoleReach = 1e-12;  ///< nearer to it than this C is open, as kinematics::inverse() has it

/// A and C that bring a normal (of length 1) under the beam, as [A] eq. 11 for both signs: with s for
/// RotaryTable::sense the beam is (sin A sin C, s sin A cos C, cos A) in the workpiece.
std::array<double, 2> tilt_and_turn(double sense, const Vector3& normal, double branch, double near_c_rad) {
  const double reach = std::hypot(normal.x(), normal.y());
  if (reach <= kPoleReach) {
    // What C does not turn away: A takes up the part that is left, of either sign.
    const double y = sense * std::sin(near_c_rad) * normal.x() + std::cos(near_c_rad) * normal.y();
    return {sense * std::atan2(y, normal.z()), near_c_rad};
  }
  return {branch * std::atan2(reach, normal.z()), std::atan2(branch * normal.x(), branch * sense * normal.y())};
}

Result<SevenAxes> axes_at(const kinematics::Machine& machine, const RotaryTable& table, const SurfacePoint& target,
                          const SurfacePoint& stage, double branch, double near_c_rad) {
  const double length = stage.normal.norm();
  if (!stage.position_mm.allFinite() || !target.position_mm.allFinite() || !(length > 0) || !std::isfinite(length)) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("a position that is not finite, or a normal of length {}: it must be above 0", length)};
  }
  const auto [a, c] = tilt_and_turn(table.sense, stage.normal / length, branch, near_c_rad);
  const double c_rad = kinematics::allowed_turn(c, near_c_rad, machine.joints[4].limits);
  const Vector3 at = table.turned(a, c_rad, stage.position_mm);
  const std::array joints{at.x(), at.y(), at.z(), a, c_rad};
  GRAVURE_CHECK(kinematics::check_positions(machine, joints));
  const Vector3 field = table.turned(a, c_rad, target.position_mm - stage.position_mm + table.centre_mm);
  return SevenAxes{at.x(), at.y(), at.z(), a, c_rad, field.x(), field.y(), field.z()};
}

}  // namespace

Result<std::vector<SevenAxes>> seven_axes(const kinematics::Machine& machine, std::span<const SurfacePoint> targets,
                                          std::span<const SurfacePoint> stages, kinematics::Branch branch) {
  GRAVURE_TRY(const RotaryTable table, rotary_table(machine));
  const double sign = branch == kinematics::Branch::positive ? 1 : -1;
  std::vector<SevenAxes> axes;
  axes.reserve(targets.size());
  double near_c_rad = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    Result<SevenAxes> at = axes_at(machine, table, targets[i], stages[i], sign, near_c_rad);
    if (!at) {
      const Vector3& p = stages[i].position_mm;
      return Error{at.error().code, fmt::format("point {} (stages at x = {} mm, y = {} mm, z = {} mm): {}", i, p.x(),
                                                p.y(), p.z(), at.error().message)};
    }
    near_c_rad = at.value().c_rad;
    axes.push_back(at.value());
  }
  return axes;
}

}  // namespace gravure::texture
