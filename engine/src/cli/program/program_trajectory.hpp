#pragma once

#include <memory>
#include <string>

#include "gravure/core/program.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/scan/job_trajectory.hpp"

namespace gravure::cli {

/// A program and the trajectories of its lines.
struct ProgramTrajectory {
  std::unique_ptr<LineSource> program;
  scan::JobTrajectory trajectory;
};

/// Opens a program whose plan describes the scanner. The set-points it stores must be those of its plan, to a count
/// (another mathematical library may round a tie the other way); bad_file otherwise, bad_argument without a scanner.
Result<ProgramTrajectory> open_trajectory(const std::string& path);

/// Fails with out_of_range, naming the option, unless 0 <= value < count.
Result<void> check_index(const char* option, std::int64_t value, std::int64_t count);

}  // namespace gravure::cli
