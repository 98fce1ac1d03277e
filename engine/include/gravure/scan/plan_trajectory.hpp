#pragma once

#include "gravure/core/plan.hpp"
#include "gravure/scan/line_trajectory.hpp"

namespace gravure::scan {

/// Which way the axis moves across the lines: stages of flat jobs go to and fro, pass after pass.
enum class Sweep : std::uint8_t { onwards, backwards };

/// The head a plan describes, its directions those of the raster modes.
kinematics::ScanHead scan_head(const ScannerPlan& scanner);

/// What a plan says of its lines: the cylinder of rotary and helical jobs (the carriage included), the panel of flat
/// ones. Fails with bad_argument where the plan has no scanner or sweeps a cylinder backwards, and as
/// cylinder_geometry() and plane_geometry() do.
Result<LineGeometry> plan_geometry(const Plan& plan, Sweep sweep = Sweep::onwards);

/// The trajectory of the plan's lines; of a helical plan that of lines that start on a whole column (docs/scan.md says
/// how the others follow). Fails as plan_geometry(), parse_field_grid() and make_line_trajectory() do.
Result<LineTrajectory> plan_trajectory(const Plan& plan, Sweep sweep = Sweep::onwards);

}  // namespace gravure::scan
