#include "gravure/scan/set_point_csv.hpp"

#include <fmt/format.h>

#include <iterator>

namespace gravure::scan {

std::string set_points_csv(const LineTrajectory& trajectory, Direction direction) {
  const LineTiming& timing = trajectory.path.timing();
  const char* const name = direction == Direction::forward ? "forward" : "reverse";
  std::string text = "direction,set_point,slot,tick,u_mm,v_mm,u_count,v_count\n";
  std::int64_t slot = 0;
  std::int64_t number = 0;
  for (const SetPoint& point : trajectory.set_points(direction)) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{}\n", name, number, slot,
                   slot * timing.ticks_per_slot, point.u_mm, point.v_mm, point.u_count, point.v_count);
    ++number;
    slot += timing.slots_per_microvector;
  }
  return text;
}

}  // namespace gravure::scan
