#pragma once

#include "gravure/scan/line_trajectory.hpp"

namespace gravure::scan {

/// The time of set-point `index` of a line, in slots: early by the lag.
double set_point_slot(const LineTiming& timing, std::int64_t lag_ticks, std::int64_t index) noexcept;

/// The order for where the path is at a slot, U shifted; field grid undone, whole counts. Fails with out_of_range where
/// the grid ends while a line is marked, and beyond kMostCount.
Result<SetPoint> set_point_at(const LineTrajectory& trajectory, Direction direction, double slot, double u_shift_mm);

/// Where the mirrors are a share of the way from one order to the next; the field's distortion included, where rounding
/// (and with it the grid) is on.
kinematics::FieldPoint between(const LineTrajectory& trajectory, const SetPoint& from, const SetPoint& to, double share,
                               bool rounding);

/// To whole counts.
kinematics::FieldPoint rounded(const kinematics::FieldPoint& point, double resolution_mm) noexcept;

}  // namespace gravure::scan
