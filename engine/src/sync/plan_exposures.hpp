#pragma once

#include <cstdint>

#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"
#include "violations.hpp"

namespace gravure::sync_plan {

/// How the images come onto the workpiece: the carriage's window in helical mode, else bands where an image of
/// `columns` is wider than the scan field, each exposed in `exposures` revolutions (passes; helical: the layers there
/// are). Fills plan.carriage, plan.bands and plan.job.revolutions, as far as the values are in order, and returns the
/// pixels of a line. Needs the lines of a revolution.
std::int64_t plan_exposures(const Job& job, std::int64_t columns, std::int64_t exposures, Plan& plan,
                            Violations& violations);

}  // namespace gravure::sync_plan
