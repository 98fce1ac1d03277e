#pragma once

#include "gravure/core/error.hpp"
#include "gravure/core/plan.hpp"

namespace gravure::plan_json {

/// bad_file unless a plan from outside is one make_plan() could have made: nothing that divides is 0, the windows lie
/// in the line, and every figure that follows from others does. Names the first key that is wrong.
Result<void> check_plan(const Plan& plan);

}  // namespace gravure::plan_json
