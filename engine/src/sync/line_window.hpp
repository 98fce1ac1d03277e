#pragma once

#include <cstdint>

#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"
#include "violations.hpp"

namespace gravure::sync_plan {

/// Pixels, slots, microvectors and the bidirectional offset of the shortest line: pixels + turn_slots rounded up to
/// whole microvectors.
void plan_line(const ScannerSettings& scanner, std::int64_t pixels_per_line, std::int64_t ticks_per_slot,
               LinePlan& line);

/// The longest line max_extra_slots allows, whole microvectors beyond line.slots.
std::int64_t longest_line_slots(const ScannerSettings& scanner, const LinePlan& line);

/// Both marking windows stay inside a line of `slots`?
bool window_fits(const LinePlan& line, std::int64_t slots);

/// Complains when even the longest line does not hold the reverse window.
void check_window(const Job& job, const LinePlan& line, std::int64_t longest_line, std::int64_t ticks_per_slot,
                  Violations& violations);

/// Sets the first slots of the marking windows from line.slots; window_fits() must hold.
void place_window(LinePlan& line);

}  // namespace gravure::sync_plan
