#pragma once

#include <optional>
#include <string>

#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"
#include "gravure/scan/job_trajectory.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// Fills in what the job leaves to its files: the text of the field grid.
Result<void> read_scanner_files(Job& job);

/// The trajectories of a plan's lines, where there is a scanner. Its warnings go to the plan's. Fails, with the place
/// of the key, where the scanner cannot follow the lines.
Result<std::optional<scan::JobTrajectory>> check_trajectory(const Job& job, Plan& plan);

/// What `plan` prints of it: rows of text, and what stands under scanner.trajectory.
std::string trajectory_text(const scan::LineTrajectory& trajectory);
Json trajectory_json(const scan::LineTrajectory& trajectory);

}  // namespace gravure::cli
