#pragma once

#include <string>

#include "gravure/scan/line_trajectory.hpp"

namespace gravure::scan {

/// The set-points of one line as CSV: direction, set-point, slot, tick (from the start of the line), u_mm, v_mm,
/// u_count, v_count; millimetres in the shortest digits that give the same double.
std::string set_points_csv(const LineTrajectory& trajectory, Direction direction);

}  // namespace gravure::scan
