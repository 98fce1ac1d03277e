#pragma once

#include "gravure/core/exact.hpp"
#include "gravure/core/plan.hpp"

namespace gravure {

/// How far the axis leads (negative: lags) after `lines` lines from the start of the job, in lines: N rel.
Rational drift_lines_after(const Plan& plan, const Integer& lines);

/// The same in micrometres on the surface.
Rational drift_um_after(const Plan& plan, const Integer& lines);

/// What the axis has gained where a revolution ends and the next begins; positive: the axis leads.
struct Seam {
  Rational step_um = 0;            ///< between the two ends of this one revolution
  Rational accumulated_lines = 0;  ///< since the start of the job
  Rational accumulated_um = 0;
};

/// The seam at the end of revolution `revolution`, which counts from 0.
Seam seam_after_revolution(const Plan& plan, const Integer& revolution);

/// Where the workpiece should stand at the start of line `line`, counted from 0 over the whole job, in turns:
/// line / nL. Line 0 starts at 0.
Rational wanted_turns_at_line(const Plan& plan, const Integer& line);

/// A-B edges that should have been sent by the start of line `line`, counted over the whole job: an exact ratio, so the
/// edges a perfect axis has seen are its floor.
Rational wanted_edges_at_line(const Plan& plan, const Integer& line);

/// The same for what the plan's counter emits on average, drift included: wanted edges * (1 + rel).
Rational emitted_edges_at_line(const Plan& plan, const Integer& line);

}  // namespace gravure
