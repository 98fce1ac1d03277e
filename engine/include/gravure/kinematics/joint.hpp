#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

namespace gravure::kinematics {

using Vector3 = Eigen::Vector3d;

enum class JointKind : std::uint8_t { prismatic, revolute };

/// What a joint carries: the workpiece or the scan head.
enum class Side : std::uint8_t { workpiece, tool };

/// In the joint's own unit: mm for prismatic, rad for revolute joints (and per s, s^2, s^3). What is absent is not
/// checked.
struct JointLimits {
  std::optional<double> least;
  std::optional<double> most;
  std::optional<double> max_speed;
  std::optional<double> max_acceleration;
  std::optional<double> max_jerk;
};

/// One axis of a machine. Axis and origin are given in the machine's frame with every joint at 0: a revolute joint at q
/// turns what it carries by q (right-hand rule) about the line through `origin_mm` along `axis`, a prismatic one shifts
/// it by q along `axis`. The sense of an axis is the sign of `axis`; a mirrored sign convention needs nothing else.
struct Joint {
  std::string name;
  JointKind kind = JointKind::prismatic;
  Side side = Side::tool;
  Vector3 axis = Vector3::UnitX();      ///< length 1
  Vector3 origin_mm = Vector3::Zero();  ///< revolute: a point of the axis; prismatic: without effect
  JointLimits limits;
};

}  // namespace gravure::kinematics
