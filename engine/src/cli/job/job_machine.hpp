#pragma once

#include <optional>
#include <vector>

#include "gravure/core/job.hpp"
#include "gravure/formats/machine_file.hpp"
#include "gravure/scan/joint_reach.hpp"

namespace gravure::cli {

/// Reads [machine] file, where the job names one, and fills in what it gives: the settings of the scan head, and the
/// limits of the axes that the job's mode moves (apply_machine()).
Result<std::optional<kinematics::Machine>> read_machine_of(Job& job);

/// The rotary axis is the revolute joint along U, the carriage the prismatic joint along U, the stage the one along V.
/// Fails with bad_argument where a key of the job gives the same again (with the place of each), where several joints
/// could be the axis, and where U, V and beam are left-handed: the raster modes count V from line to line.
Result<void> apply_machine(const MachineFile& file, Job& job);

/// Where the joints of the job's machine go (scan::joint_reach()); none without one. Fails with the place of [machine]
/// file where one of them leaves its limits.
Result<std::vector<scan::JointReach>> reach_of_machine(const std::optional<kinematics::Machine>& machine,
                                                       const Job& job, const Plan& plan);

}  // namespace gravure::cli
