#pragma once

#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"
#include "violations.hpp"

namespace gravure::sync_plan {

/// How the axes with all three limits come from rest to their marking speed and back; the plan is complete but for
/// that. Complains where an axis marks faster than its max_speed, and where a spin-up lasts longer than the board
/// counts. Errors are those of the planner of ramps (motion).
Result<void> plan_spins(const Job& job, Plan& plan, Violations& violations);

}  // namespace gravure::sync_plan
