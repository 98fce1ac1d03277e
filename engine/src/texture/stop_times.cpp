#include "gravure/texture/stop_times.hpp"

#include <algorithm>
#include <cmath>

#include "gravure/motion/plan_profile.hpp"
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

double rest_to_rest_s(double distance, const AxisBounds& limits) {
  motion::JerkRequest request;
  request.move = {std::abs(distance), limits.speed, limits.acceleration, limits.acceleration};
  request.jerk_up_mm_s3 = limits.jerk;
  request.jerk_down_mm_s3 = limits.jerk;
  const Result<motion::Profile> profile = motion::plan_profile(request);
  return profile ? profile.value().access_time_s() : 0;
}

namespace {

double slowest_s(const SevenAxes& from, const SevenAxes& to, const SevenLimits& limits, std::size_t first,
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

double stop_time_s(std::span<const SevenAxes> axes, std::span<const std::size_t> stops, const SevenLimits& limits,
                   std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
    sum += slowest_s(axes[stops[k]], axes[stops[k + 1]], limits, first, last);
  }
  return sum;
}

double dilated_stop_time_s(std::span<const SevenAxes> axes, std::span<const std::size_t> stops,
                           const SevenLimits& limits) {
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
