#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <numbers>
#include <optional>

#include "chain.hpp"
#include "gravure/kinematics/machine.hpp"

namespace gravure::kinematics {
namespace {

/// The beam's tilt towards U and V: columns d/dU and d/dV of beam_of(), in the head's axes.
Eigen::Matrix<double, 3, 2> beam_slope(const ScanHead& head, const FieldPoint& field) {
  Eigen::Matrix<double, 3, 2> slope = Eigen::Matrix<double, 3, 2>::Zero();
  if (head.lens != Lens::f_theta || head.tilt_rad_per_mm == 0) {
    return slope;
  }
  const double tilt = head.tilt_rad_per_mm;
  const double r = std::hypot(field.u_mm, field.v_mm);
  if (r == 0) {
    slope(0, 0) = slope(1, 1) = -tilt;
    return slope;
  }
  const Eigen::Vector2d e(field.u_mm / r, field.v_mm / r);
  const double sine = std::sin(tilt * r);
  const double cosine = std::cos(tilt * r);
  // beam = (-sin(tilt r) e, cos(tilt r)); de/du = (1 - e e^T) / r
  slope.topRows<2>() =
      -(tilt * cosine) * (e * e.transpose()) - (sine / r) * (Eigen::Matrix2d::Identity() - e * e.transpose());
  slope.row(2) = -tilt * sine * e.transpose();
  return slope;
}

}  // namespace

Spot forward(const Machine& machine, std::span<const double> joints, const FieldPoint& field) {
  const Frames frames = frames_at(machine, joints);
  const ScanHead& head = machine.head;
  const Vector3 beam = beam_of(head, field);
  const Vector3 point = head.origin_mm + from_head(head, Vector3(field.u_mm, field.v_mm, 0) + field.w_mm * beam);
  const Eigen::Matrix3d back = frames.workpiece.linear().transpose();
  return {back * (frames.tool * point - frames.workpiece.translation()),
          back * (frames.tool.linear() * from_head(head, beam))};
}

Jacobian jacobian(const Machine& machine, std::span<const double> joints, const FieldPoint& field) {
  const Frames frames = frames_at(machine, joints);
  const std::vector<Screw> screws = screws_at(machine, joints);
  const ScanHead& head = machine.head;
  const Vector3 in_head = beam_of(head, field);
  const Vector3 beam = frames.tool.linear() * from_head(head, in_head);
  const Vector3 point =
      frames.tool * (head.origin_mm + from_head(head, Vector3(field.u_mm, field.v_mm, 0) + field.w_mm * in_head));
  const Eigen::Matrix3d back = frames.workpiece.linear().transpose();

  const auto count = static_cast<Eigen::Index>(joints.size());
  Jacobian result;
  result.position.setZero(3, count + 3);
  result.towards_head.setZero(3, count + 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Joint& joint = machine.joints[static_cast<std::size_t>(i)];
    const Screw& screw = screws[static_cast<std::size_t>(i)];
    const double sense = joint.side == Side::tool ? 1 : -1;  // moving the workpiece moves the spot the other way
    if (joint.kind == JointKind::prismatic) {
      result.position.col(i) = sense * (back * screw.axis);
    } else {
      result.position.col(i) = sense * (back * screw.axis.cross(point - screw.point_mm));
      result.towards_head.col(i) = sense * (back * screw.axis.cross(beam));
    }
  }
  const Eigen::Matrix<double, 3, 2> slope = beam_slope(head, field);
  const Eigen::Matrix3d turn = back * frames.tool.linear();
  const auto to_workpiece = [&](const Vector3& vector) -> Vector3 { return turn * from_head(head, vector); };
  for (Eigen::Index k = 0; k < 2; ++k) {
    result.towards_head.col(count + k) = to_workpiece(slope.col(k));
    result.position.col(count + k) = to_workpiece(Vector3::Unit(k) + field.w_mm * slope.col(k));
  }
  result.position.col(count + 2) = to_workpiece(in_head);
  return result;
}

Result<FieldPoint> field_of(const Machine& machine, std::span<const double> joints, const Vector3& position_mm) {
  const Frames frames = frames_at(machine, joints);
  const Vector3 in_tool = frames.tool.inverse() * (frames.workpiece * position_mm);
  return field_of_point(machine.head, to_head(machine.head, in_tool - machine.head.origin_mm));
}

Result<void> check_positions(const Machine& machine, std::span<const double> joints) {
  assert(joints.size() == machine.joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = machine.joints[i];
    const bool is_low = joint.limits.least && joints[i] < *joint.limits.least;
    const bool is_high = joint.limits.most && joints[i] > *joint.limits.most;
    if (is_low || is_high) {
      const bool is_turning = joint.kind == JointKind::revolute;
      const auto in_unit = [&](const std::optional<double>& value) {
        return value ? fmt::format("{:.9g}", is_turning ? *value * 180 / std::numbers::pi : *value) : "any";
      };
      return Error{ErrorCode::out_of_range,
                   fmt::format("kinematics: joint {} at {} {}: its limits are {} to {}", joint.name, in_unit(joints[i]),
                               is_turning ? "deg" : "mm", in_unit(joint.limits.least), in_unit(joint.limits.most))};
    }
  }
  return {};
}

}  // namespace gravure::kinematics
