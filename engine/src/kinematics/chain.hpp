#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "gravure/kinematics/machine.hpp"

namespace gravure::kinematics {

/// Where workpiece and tool stand in the machine's frame.
struct Frames {
  Eigen::Isometry3d workpiece = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d tool = Eigen::Isometry3d::Identity();
};

/// A joint's axis in the machine's frame at a pose.
struct Screw {
  Vector3 axis;
  Vector3 point_mm;
};

/// The motion of one joint at `position`, in the frame all share at 0.
Eigen::Isometry3d motion_of(const Joint& joint, double position);

Frames frames_at(const Machine& machine, std::span<const double> joints);

/// The axes as the joints before each leave them.
std::vector<Screw> screws_at(const Machine& machine, std::span<const double> joints);

/// A vector of the head's own axes in the shared frame.
Vector3 from_head(const ScanHead& head, const Vector3& in_head);
/// And back.
Vector3 to_head(const ScanHead& head, const Vector3& vector);

}  // namespace gravure::kinematics
