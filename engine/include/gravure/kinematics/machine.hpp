#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/kinematics/joint.hpp"
#include "gravure/kinematics/scan_head.hpp"

namespace gravure::kinematics {

/// A chain of joints with a scan head at one end and the workpiece at the other. The joints of each side stand in the
/// order in which they carry each other, the one on the machine's frame first. With every joint at 0 workpiece, head
/// and machine share one frame.
struct Machine {
  std::string title;
  std::vector<Joint> joints;
  ScanHead head;
};

/// Positions of the joints, in the order of Machine::joints; mm and rad.
using JointPositions = std::vector<double>;

/// Where the light lands, in the frame of the workpiece.
struct Spot {
  Vector3 position_mm = Vector3::Zero();
  Vector3 towards_head = Vector3::UnitZ();  ///< length 1; the surface's normal at normal incidence
};

/// How a spot moves. One column for each joint, then one each for U, V and w; per mm or per rad.
struct Jacobian {
  Eigen::Matrix<double, 3, Eigen::Dynamic> position;
  Eigen::Matrix<double, 3, Eigen::Dynamic> towards_head;
};

/// Fails with bad_argument or out_of_range, naming the joint or the head's field, where the description contradicts
/// itself: names missing or twice, axes not of length 1, head axes not at right angles, limits that leave nothing.
Result<void> check_machine(const Machine& machine);

/// The joint's place in the machine; bad_argument with the names there are.
Result<std::size_t> find_joint(const Machine& machine, std::string_view name);

/// Joints and field point -> spot, p = T_workpiece^-1 T_tool (U, V, w); [A] eqs 11 to 13 for an X-Y-Z-A-C machine.
/// Takes as many positions as the machine has joints.
Spot forward(const Machine& machine, std::span<const double> joints, const FieldPoint& field);

/// Its derivative, analytic (the twists of the joints at the pose).
Jacobian jacobian(const Machine& machine, std::span<const double> joints, const FieldPoint& field);

/// The galvo's half of the inverse: where in the field a workpiece point lies with the joints where they are.
/// w_mm is its distance from focus. Fails as field_of_point() does; does not compare with the field's size.
Result<FieldPoint> field_of(const Machine& machine, std::span<const double> joints, const Vector3& position_mm);

/// Fails with out_of_range, naming joint, position and limits, where a joint lies outside its limits.
Result<void> check_positions(const Machine& machine, std::span<const double> joints);

}  // namespace gravure::kinematics
