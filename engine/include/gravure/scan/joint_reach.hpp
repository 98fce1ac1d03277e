#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gravure/core/plan.hpp"
#include "gravure/kinematics/machine.hpp"

namespace gravure::scan {

/// From where to where a joint goes in a job, from rest to rest.
struct JointReach {
  std::string joint;
  kinematics::JointKind kind = kinematics::JointKind::prismatic;
  double least = 0;  ///< mm or deg
  double most = 0;
  std::optional<double> least_allowed;  ///< the limits of the joint, in the same unit
  std::optional<double> most_allowed;

  /// To 1e-9 of the unit, which is arithmetic.
  bool is_within_limits() const noexcept {
    return (!least_allowed || least >= *least_allowed - 1e-9) && (!most_allowed || most <= *most_allowed + 1e-9);
  }
};

/// The joint of this kind along a direction of the machine's frame, either way; none where there is none. Fails with
/// bad_argument where there are several, naming two and `use`.
Result<std::optional<std::size_t>> joint_along(const kinematics::Machine& machine, kinematics::JointKind kind,
                                               const kinematics::Vector3& direction, const std::string& use);

/// Where the joints of a machine are over a whole job of a raster mode, ramps and bands included; in the order of the
/// machine's joints. Column 0 (and in flat jobs line 0) of the image lies at 0 of the machine's frame along U (along
/// V), the focus goes where the mode has it: radius * cos(offset) above the axis of the revolute joint along U, in flat
/// jobs where it is with every joint at 0. The rotary axis counts from where it stands at rest, or from tick 0 where
/// it turns already, turns included. Joints that the mode does not move stay at 0; a direction without a joint is
/// set by hand and not in the answer. Fails as plan_geometry() and joint_along() do.
Result<std::vector<JointReach>> joint_reach(const kinematics::Machine& machine, const Plan& plan);

/// Fails with out_of_range, a line for each joint that leaves its limits: its name, where it goes, what is allowed.
Result<void> check_reach(const std::vector<JointReach>& joints);

}  // namespace gravure::scan
