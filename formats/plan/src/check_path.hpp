#pragma once

#include "complaint.hpp"
#include "gravure/core/plan.hpp"

namespace gravure::plan_json {

/// The part of a plan that follows a path; its clock and line have been checked.
void check_path(const Plan& plan, Complaint& complaint);

}  // namespace gravure::plan_json
