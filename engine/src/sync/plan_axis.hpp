#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"
#include "gravure/sync/ab_ratio.hpp"
#include "violations.hpp"

namespace gravure::sync_plan {

/// What an axis that follows the seed clock is asked to do, whichever section of the job describes it.
struct AxisRequest {
  std::string section;  ///< "rotary", "stage", "carriage"
  int interpolation_bits = 0;
  std::int64_t max_ab_hz = 0;
  Rational edges_per_revolution = 0;  ///< A-B edges in the time of a revolution (pass)
  Rational travel_um = 0;             ///< in the same time
  /// rotary: encoder turns for one of the workpiece; else: travel of one encoder line. What a remedy may change.
  Rational scale = 1;
  bool fraction = false;  ///< its channel has the second accumulator: that of the carriage never has
};

/// The axis the lines are spaced by: the workpiece's, or the stage in flat mode. The axis part of the plan is filled.
AxisRequest cross_scan_axis(const Job& job, const Plan& plan);
AxisRequest carriage_axis(const Job& job, const Plan& plan);

/// A-B edges for `travel_um` on a linear encoder.
Rational linear_edges(const Rational& travel_um, const Rational& encoder_pitch_um, int interpolation_bits);

/// The counter's solution for one length of line.
struct AbSolution {
  AbPair pair;
  AbFraction fraction;
  Rational wanted_increment;
  Rational relative_error;  ///< (emitted / wanted) - 1
};

/// A-B periods per second the motion control wants for a line of `slots`, [B] eqs 3 to 5.
Rational wanted_hz(const Plan& plan, const AxisRequest& axis, std::int64_t slots);
/// Complains where even the longest line needs more than can be emitted or taken; the message says what would fit.
void check_reach(const Job& job, const Plan& plan, const AxisRequest& axis, std::int64_t longest_line,
                 Violations& violations);

/// The length of line with the smallest drift (of the axis that drifts most), and the solution of each axis. Only
/// lengths that hold the marking window and whose frequencies are within reach count; the longest does.
Result<std::vector<AbSolution>> choose_line(const Job& job, const std::vector<AxisRequest>& axes, Plan& plan,
                                            std::int64_t longest_line);

/// The figures of a channel that follow from its solution and the length of the line.
AbPlan ab_plan(const Job& job, const Plan& plan, const AxisRequest& axis, const AbSolution& solution);

}  // namespace gravure::sync_plan
