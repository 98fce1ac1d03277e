#include <fmt/format.h>

#include <cmath>
#include <set>

#include "gravure/kinematics/machine.hpp"

namespace gravure::kinematics {
namespace {

constexpr double kLengthSlack = 1e-9;
constexpr std::size_t kMostJoints = 32;
constexpr int kLeastBits = 8;
constexpr int kMostBits = 26;
constexpr double kMostFieldMm = 10'000;
constexpr double kMostTilt = 1.0;  // rad at the corner of the field

bool is_unit(const Vector3& vector) {
  return vector.allFinite() && std::abs(vector.norm() - 1) <= kLengthSlack;
}

Error wrong(ErrorCode code, std::string_view what, std::string_view text) {
  return {code, fmt::format("kinematics: {}: {}", what, text)};
}

Result<void> check_positive(const std::string& what, std::string_view field, const std::optional<double>& value) {
  if (value && !(*value > 0 && std::isfinite(*value))) {
    return wrong(ErrorCode::out_of_range, what,
                 fmt::format("{} = {}: must be a finite number above 0, or absent", field, *value));
  }
  return {};
}

Result<void> check_joint(const Joint& joint, std::set<std::string>& names) {
  const std::string what = "joint " + joint.name;
  if (joint.name.empty() || !names.insert(joint.name).second) {
    return wrong(ErrorCode::bad_argument, what, "give every joint a name of its own");
  }
  if (!is_unit(joint.axis) || !joint.origin_mm.allFinite()) {
    return wrong(ErrorCode::out_of_range, what,
                 fmt::format("axis of length {}: must be 1, and the origin finite", joint.axis.norm()));
  }
  const JointLimits& limits = joint.limits;
  if ((limits.least && std::isnan(*limits.least)) || (limits.most && std::isnan(*limits.most)) ||
      (limits.least && limits.most && *limits.least > *limits.most)) {
    return wrong(ErrorCode::bad_argument, what, "its position limits leave no position: least must be at most most");
  }
  GRAVURE_CHECK(check_positive(what, "max_speed", limits.max_speed));
  GRAVURE_CHECK(check_positive(what, "max_acceleration", limits.max_acceleration));
  return check_positive(what, "max_jerk", limits.max_jerk);
}

Result<void> check_head(const ScanHead& head) {
  if (!is_unit(head.u_axis) || !is_unit(head.v_axis) || !is_unit(head.beam_axis) ||
      std::abs(head.u_axis.dot(head.v_axis)) > kLengthSlack ||
      std::abs(head.u_axis.dot(head.beam_axis)) > kLengthSlack ||
      std::abs(head.v_axis.dot(head.beam_axis)) > kLengthSlack || !head.origin_mm.allFinite()) {
    return wrong(ErrorCode::bad_argument, "scan head",
                 "the axes of U, V and the beam must have length 1 and stand at right angles");
  }
  if (!(head.field_mm > 0 && head.field_mm <= kMostFieldMm)) {
    return wrong(ErrorCode::out_of_range, "scan head",
                 fmt::format("field_mm = {}: must be above 0 and at most {}", head.field_mm, kMostFieldMm));
  }
  if (head.resolution_bits < kLeastBits || head.resolution_bits > kMostBits) {
    return wrong(ErrorCode::out_of_range, "scan head",
                 fmt::format("resolution_bits = {}: must be {} to {}", head.resolution_bits, kLeastBits, kMostBits));
  }
  const double corner = head.field_mm * std::sqrt(0.5) * head.tilt_rad_per_mm;
  if (!(head.tilt_rad_per_mm >= 0 && corner <= kMostTilt)) {
    return wrong(ErrorCode::out_of_range, "scan head",
                 fmt::format("tilt_rad_per_mm = {:.6g}: must be 0 to {:.6g} with a field of {:.6g} mm",
                             head.tilt_rad_per_mm, kMostTilt / (head.field_mm * std::sqrt(0.5)), head.field_mm));
  }
  if (head.lens == Lens::telecentric && head.tilt_rad_per_mm != 0) {
    return wrong(ErrorCode::bad_argument, "scan head",
                 fmt::format("tilt_rad_per_mm = {} of a telecentric lens: make it 0, or the lens f_theta",
                             head.tilt_rad_per_mm));
  }
  if (head.lag_us < 0) {
    return wrong(ErrorCode::out_of_range, "scan head", "lag_us = " + to_string(head.lag_us) + ": must be 0 or more");
  }
  GRAVURE_CHECK(check_positive("scan head", "max_speed_mm_s", head.max_speed_mm_s));
  GRAVURE_CHECK(check_positive("scan head", "max_acceleration_mm_s2", head.max_acceleration_mm_s2));
  return check_positive("scan head", "max_jerk_mm_s3", head.max_jerk_mm_s3);
}

}  // namespace

Result<void> check_machine(const Machine& machine) {
  if (machine.joints.size() > kMostJoints) {
    return wrong(ErrorCode::out_of_range, "machine",
                 fmt::format("{} joints: at most {} are allowed", machine.joints.size(), kMostJoints));
  }
  std::set<std::string> names;
  for (const Joint& joint : machine.joints) {
    GRAVURE_CHECK(check_joint(joint, names));
  }
  return check_head(machine.head);
}

Result<std::size_t> find_joint(const Machine& machine, std::string_view name) {
  std::string names;
  for (std::size_t i = 0; i < machine.joints.size(); ++i) {
    if (machine.joints[i].name == name) {
      return i;
    }
    names += (i == 0 ? "" : ", ") + machine.joints[i].name;
  }
  return Error{ErrorCode::bad_argument,
               fmt::format("kinematics: no joint \"{}\"; the machine has {}", name, names.empty() ? "none" : names)};
}

}  // namespace gravure::kinematics
