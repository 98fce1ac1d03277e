#pragma once

#include <string>
#include <vector>

#include "gravure/core/board_runs.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// A run of the board as it came out.
struct EmulatedRun {
  BoardRun run;
  DeviceStatus status;  ///< at its end, or where it was left
};

/// Edges of the axis over all runs of the job up to a tick, without ramps; backwards ones count as well.
Integer edges_to_tick(const Plan& plan, std::int64_t tick);

/// The axis at a tick of the job as its run has it: counts and edges from where the lines of the run began.
Json run_axis_json(const Plan& plan, const EmulatedRun& run);

Json runs_json(const Plan& plan, const std::vector<EmulatedRun>& runs);
/// Nothing where there is one run.
std::string runs_text(const Plan& plan, const std::vector<EmulatedRun>& runs);

}  // namespace gravure::cli
