#include "set_point_at.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gravure::scan {
namespace {

using kinematics::FieldPoint;

constexpr double kMostCount = 1 << 30;

/// Counts beyond the field are counts like others here: scanners reach further than they mark. Frames cannot carry
/// them.
Result<std::int32_t> count_of(double position_mm, const char* axis, double resolution_mm) {
  const double count = std::round(position_mm / resolution_mm);
  if (!(std::abs(count) <= kMostCount)) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("scan: set-point {} = {:.9g} mm: beyond {} counts of {:.9g} mm; take a larger field_mm, fewer "
                    "pixels or a shorter turn",
                    axis, position_mm, kMostCount, resolution_mm)};
  }
  return static_cast<std::int32_t>(count);
}

/// At a slot of this line or, early by the lag, of the next.
bool is_marking(const LinePath& path, Direction direction, double slot) noexcept {
  const LineTiming& timing = path.timing();
  const bool is_next = slot >= static_cast<double>(timing.slots);
  const bool turned = is_next && timing.bidirectional;
  const Direction here = (direction == Direction::forward) != turned ? Direction::forward : Direction::reverse;
  const LinePath::Window marks = path.marking(here);
  const double within = slot - (is_next ? static_cast<double>(timing.slots) : 0);
  return within >= marks.begin && within <= marks.end;
}

/// The order that lands at `place`. In a turn nothing lands: beyond the grid its edge says what the distortion is.
Result<GridPoint> order_for(const FieldGrid& grid, const GridPoint& place, bool marking) {
  if (marking) {
    return grid.command_for(place);
  }
  const GridPoint edge{std::clamp(place.u_mm, grid.u_first_mm, grid.u_last_mm),
                       std::clamp(place.v_mm, grid.v_first_mm, grid.v_last_mm)};
  GRAVURE_TRY(const GridPoint landed, grid.lands_at(edge));
  if (edge.u_mm == place.u_mm && edge.v_mm == place.v_mm) {
    if (const auto order = grid.command_for(place)) {
      return order.value();
    }
  }
  return GridPoint{place.u_mm - (landed.u_mm - edge.u_mm), place.v_mm - (landed.v_mm - edge.v_mm)};
}

}  // namespace

double set_point_slot(const LineTiming& timing, std::int64_t lag_ticks, std::int64_t index) noexcept {
  const std::int64_t tick = index * timing.slots_per_microvector * timing.ticks_per_slot + lag_ticks;
  return static_cast<double>(tick) / static_cast<double>(timing.ticks_per_slot);
}

Result<SetPoint> set_point_at(const LineTrajectory& trajectory, Direction direction, double slot, double u_shift_mm) {
  FieldPoint wanted = trajectory.path.at(direction, slot);
  wanted.u_mm += u_shift_mm;
  GridPoint order{wanted.u_mm, wanted.v_mm};
  if (trajectory.options.field_grid) {
    GRAVURE_TRY(order, order_for(*trajectory.options.field_grid, order, is_marking(trajectory.path, direction, slot)));
  }
  SetPoint point{wanted.u_mm, wanted.v_mm, 0, 0};
  GRAVURE_TRY(point.u_count, count_of(order.u_mm, "U", trajectory.resolution_mm));
  GRAVURE_TRY(point.v_count, count_of(order.v_mm, "V", trajectory.resolution_mm));
  return point;
}

FieldPoint between(const LineTrajectory& trajectory, const SetPoint& from, const SetPoint& to, double share,
                   bool rounding) {
  const auto position = [&](const SetPoint& point) {
    return rounding ? GridPoint{point.u_count * trajectory.resolution_mm, point.v_count * trajectory.resolution_mm}
                    : GridPoint{point.u_mm, point.v_mm};
  };
  const GridPoint a = position(from);
  const GridPoint b = position(to);
  GridPoint point{a.u_mm + share * (b.u_mm - a.u_mm), a.v_mm + share * (b.v_mm - a.v_mm)};
  if (rounding && trajectory.options.field_grid) {
    if (const auto landed = trajectory.options.field_grid->lands_at(point)) {
      point = landed.value();
    }
  }
  return {point.u_mm, point.v_mm, 0};
}

FieldPoint rounded(const FieldPoint& point, double resolution_mm) noexcept {
  return {std::round(point.u_mm / resolution_mm) * resolution_mm,
          std::round(point.v_mm / resolution_mm) * resolution_mm, 0};
}

}  // namespace gravure::scan
