#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "dice.hpp"
#include "gravure/kinematics/inverse.hpp"
#include "gravure/kinematics/machines.hpp"

namespace gravure::kinematics::test {

inline constexpr double kPi = 3.14159265358979323846;

inline ScanHead telecentric(double field_mm = 30) {
  ScanHead head;
  head.field_mm = field_mm;
  head.resolution_bits = 20;
  return head;
}

/// 100 mm focal length: the beam tilts by r / f.
inline ScanHead f_theta(double field_mm = 30) {
  ScanHead head = telecentric(field_mm);
  head.lens = Lens::f_theta;
  head.tilt_rad_per_mm = 0.01;
  return head;
}

inline double real(gravure::test::Dice& dice, double least, double most) {
  return least + (most - least) * (static_cast<double>(dice.word() >> 11U) / 9007199254740992.0);
}

inline Vector3 direction(gravure::test::Dice& dice) {
  for (;;) {
    const Vector3 v(real(dice, -1, 1), real(dice, -1, 1), real(dice, -1, 1));
    if (v.norm() > 0.1 && v.norm() < 1) {
      return v.normalized();
    }
  }
}

/// Joints anywhere: both kinds, both sides, axes and origins at random, a tilted head and either lens.
inline Machine random_chain(gravure::test::Dice& dice, int joints) {
  Machine machine;
  machine.title = "random";
  for (int i = 0; i < joints; ++i) {
    const Joint joint{"j" + std::to_string(i),
                      dice.coin() ? JointKind::prismatic : JointKind::revolute,
                      dice.coin() ? Side::workpiece : Side::tool,
                      direction(dice),
                      20 * direction(dice),
                      {}};
    machine.joints.push_back(joint);
  }
  machine.head = dice.coin() ? telecentric() : f_theta();
  machine.head.origin_mm = 10 * direction(dice);
  machine.head.beam_axis = direction(dice);
  machine.head.u_axis = machine.head.beam_axis.cross(direction(dice)).normalized();
  machine.head.v_axis = (dice.coin() ? 1 : -1) * machine.head.beam_axis.cross(machine.head.u_axis);
  return machine;
}

inline JointPositions random_joints(gravure::test::Dice& dice, const Machine& machine) {
  JointPositions joints;
  for (const Joint& joint : machine.joints) {
    joints.push_back(joint.kind == JointKind::prismatic ? real(dice, -50, 50) : real(dice, -3, 3));
  }
  return joints;
}

}  // namespace gravure::kinematics::test
