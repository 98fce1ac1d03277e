#include "gravure/texture/stop_times.hpp"

#include <algorithm>
#include <cmath>

#include "path_axes.hpp"

namespace gravure::texture {
namespace {

constexpr double kInLine = 1e-9;

bool goes_straight(const Vector3& from, const Vector3& at, const Vector3& to) {
  const Vector2 in = (at - from).head<2>();
  const Vector2 out = (to - at).head<2>();
  return (out - in).norm() <= kInLine * std::max(in.norm(), out.norm());
}

}  // namespace

std::vector<std::size_t> resting_points(std::span<const SurfacePoint> targets, Stops stops) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const bool end = i == 0 || i + 1 == targets.size();
    if (end || stops == Stops::points ||
        !goes_straight(targets[i - 1].position_mm, targets[i].position_mm, targets[i + 1].position_mm)) {
      found.push_back(i);
    }
  }
  return found;
}

RestToRest rest_to_rest(double distance, const AxisBounds& limits) {
  const double d = std::abs(distance);
  const double v = limits.speed;
  const double a = limits.acceleration;
  const double j = limits.jerk;
  if (!(d > 0)) {
    return {};
  }
  const double ramp_s = std::cbrt(d / (2 * j));  // half of a ramp that jerk alone bounds
  const bool jerk_ends_speed = v * j < a * a;    // speed is reached before acceleration
  if (jerk_ends_speed ? j * ramp_s * ramp_s <= v : j * ramp_s <= a) {
    return {4 * ramp_s, j * ramp_s * ramp_s, j * ramp_s};
  }
  if (jerk_ends_speed) {
    return {d / v + 2 * std::sqrt(v / j), v, std::sqrt(v * j)};
  }
  const double rest = a / j;
  const double reached = a / 2 * (std::sqrt(rest * rest + 4 * d / a) - rest);
  return reached <= v ? RestToRest{2 * (reached / a + rest), reached, a} : RestToRest{d / v + v / a + rest, v, a};
}

double rest_to_rest_s(double distance, const AxisBounds& limits) {
  return rest_to_rest(distance, limits).time_s;
}

namespace {

double slowest_s(const SevenAxes& from, const SevenAxes& to, const AxesLimits& limits, std::size_t first,
                 std::size_t last) {
  const auto a = values_of(from);
  const auto b = values_of(to);
  double most = 0;
  for (std::size_t axis = first; axis < last; ++axis) {
    most = std::max(most, rest_to_rest_s(b[axis] - a[axis], limits[axis]));
  }
  return most;
}

}  // namespace

double stop_time_s(std::span<const SevenAxes> axes, std::span<const std::size_t> stops, const AxesLimits& limits,
                   std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
    sum += slowest_s(axes[stops[k]], axes[stops[k + 1]], limits, first, last);
  }
  return sum;
}

double dilated_stop_time_s(std::span<const SevenAxes> axes, std::span<const std::size_t> stops,
                           const AxesLimits& limits) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
    const auto before = stages_of(axes[stops[k > 0 ? k - 1 : k]]);
    const auto from = stages_of(axes[stops[k]]);
    const auto to = stages_of(axes[stops[k + 1]]);
    double most = slowest_s(axes[stops[k]], axes[stops[k + 1]], limits, kStageAxes, limits.size());
    for (std::size_t axis = 0; axis < kStageAxes; ++axis) {
      const double bend = k > 0 ? to[axis] - 2 * from[axis] + before[axis] : 0;
      most = std::max({most, std::abs(to[axis] - from[axis]) / limits[axis].speed,
                       std::sqrt(std::abs(bend) / limits[axis].acceleration)});
    }
    sum += most;
  }
  return sum;
}

}  // namespace gravure::texture
