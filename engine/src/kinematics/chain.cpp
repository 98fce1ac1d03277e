#include "chain.hpp"

#include <cassert>

namespace gravure::kinematics {

Eigen::Isometry3d motion_of(const Joint& joint, double position) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (joint.kind == JointKind::prismatic) {
    motion.translation() = position * joint.axis;
  } else {
    motion.linear() = Eigen::AngleAxisd(position, joint.axis).toRotationMatrix();
    motion.translation() = joint.origin_mm - motion.linear() * joint.origin_mm;
  }
  return motion;
}

Frames frames_at(const Machine& machine, std::span<const double> joints) {
  assert(joints.size() == machine.joints.size());
  Frames frames;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = machine.joints[i];
    Eigen::Isometry3d& frame = joint.side == Side::workpiece ? frames.workpiece : frames.tool;
    frame = frame * motion_of(joint, joints[i]);
  }
  return frames;
}

std::vector<Screw> screws_at(const Machine& machine, std::span<const double> joints) {
  assert(joints.size() == machine.joints.size());
  Frames frames;
  std::vector<Screw> screws;
  screws.reserve(joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = machine.joints[i];
    Eigen::Isometry3d& frame = joint.side == Side::workpiece ? frames.workpiece : frames.tool;
    screws.push_back({frame.linear() * joint.axis, frame * joint.origin_mm});
    frame = frame * motion_of(joint, joints[i]);
  }
  return screws;
}

Vector3 from_head(const ScanHead& head, const Vector3& in_head) {
  return in_head.x() * head.u_axis + in_head.y() * head.v_axis + in_head.z() * head.beam_axis;
}

Vector3 to_head(const ScanHead& head, const Vector3& vector) {
  return {vector.dot(head.u_axis), vector.dot(head.v_axis), vector.dot(head.beam_axis)};
}

}  // namespace gravure::kinematics
