#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "gravure/scan/job_trajectory.hpp"
#include "gravure/twin/verify.hpp"

namespace gravure {

/// The trajectory that the program's plan leads to; none without a scanner. A plan whose lines the scanner cannot
/// follow, and stored set-points that are not those of the plan, are violations.
std::optional<scan::JobTrajectory> judge_scanner(const ProgramHeader& header, VerifyReport& report);

/// A simulated pulse beyond the bound is a violation: one of the two is wrong.
void judge_bound(const ErrorBudget& budget, VerifyReport& report);

/// Adds the error budget to a report, with what its limits have to say; a limit that cannot be judged is a violation.
/// Fails where the program cannot be read, and on cancellation.
Result<void> judge_budget(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
                          const std::optional<scan::JobTrajectory>& trajectory, const VerifyOptions& options,
                          VerifyReport& report);

}  // namespace gravure
