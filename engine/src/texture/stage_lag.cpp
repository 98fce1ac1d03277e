#include "stage_lag.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "off_the_point.hpp"

namespace gravure::texture {

double stage_lag_mm(const PathTimingRequest& request, const StageSpline& stages, const SmoothPlace& place) {
  double most = 0;
  const std::int64_t step = std::max<std::int64_t>(1, place.cell() / 2);
  for (std::int64_t period = -place.cell() * SmoothPlace::kReach; period < place.end(); period += step) {
    const PlaceState where = place.state(static_cast<double>(period), request.servo_s);
    const StageState at = stages.state(where.place);
    std::array<double, kPathAxes.size()> axes{};
    std::array<double, kPathAxes.size()> behind{};
    for (std::size_t k = 0; k < kStageAxes; ++k) {
      const ServoLoop& loop = request.servos[k];
      const double omega = 2 * std::numbers::pi * loop.natural_hz;
      const double speed = at.first[k] * where.speed;
      const double acceleration = at.second[k] * where.speed * where.speed + at.first[k] * where.acceleration;
      axes[k] = at.value[k];
      behind[k] = (2 * loop.damping * speed + (1 - 4 * loop.damping * loop.damping) / omega * acceleration) / omega;
    }
    most = std::max(most, off_the_point(request.table, axes, behind).head<2>().norm());
  }
  return most;
}

}  // namespace gravure::texture
