#pragma once

#include <string>
#include <vector>

#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"

namespace gravure::sync_plan {

/// What a plan allows but its owner should know, each said once, with numbers. Everything else of the plan is complete.
std::vector<std::string> plan_warnings(const Job& job, const Plan& plan);

}  // namespace gravure::sync_plan
