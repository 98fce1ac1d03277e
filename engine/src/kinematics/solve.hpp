#pragma once

#include <optional>
#include <vector>

#include "gravure/kinematics/inverse.hpp"

namespace gravure::kinematics {

/// A checked request.
struct Problem {
  const Machine& machine;
  Vector3 position_mm;
  std::optional<Vector3> towards_head;  ///< length 1
  FieldPoint field;
  JointPositions near;                 ///< one a joint
  std::vector<std::size_t> prismatic;  ///< free joints of each kind
  std::vector<std::size_t> revolute;
  Branch branch;
};

/// Nothing further than this from the target counts as reached: mm, and as much per mm of distance from the origin.
inline constexpr double kReached = 1e-9;

/// Which solver fits the chain.
Solver choose_solver(const Problem& problem);

Result<Pose> solve_linear(const Problem& problem);
Result<Pose> solve_cylinder(const Problem& problem);
Result<Pose> solve_tilt_turn(const Problem& problem);
Result<Pose> solve_numeric(const Problem& problem);

}  // namespace gravure::kinematics
