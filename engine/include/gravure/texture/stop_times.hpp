#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gravure/texture/axes.hpp"
#include "gravure/texture/axis_limits.hpp"
#include "gravure/texture/surface.hpp"

namespace gravure::texture {

/// Where motion along a path comes to rest.
enum class Stops : std::uint8_t {
  points,   ///< at every point, as in [A]
  corners,  ///< only where the path in the plane turns
};

/// The points at which the path rests, its ends among them. Points count as in line where the plane turns by less than
/// 1e-9 rad and they are equally far apart.
std::vector<std::size_t> resting_points(std::span<const SurfacePoint> targets, Stops stops);

/// The shortest move of one axis from rest to rest, [A] section on efficiency: what motion::plan_profile() makes with
/// equal limits to both sides, in closed form.
struct RestToRest {
  double time_s = 0;
  double speed = 0;         ///< reached, magnitude
  double acceleration = 0;  ///< reached
};
/// Limits must be above 0.
RestToRest rest_to_rest(double distance, const AxisBounds& limits);
/// Its time.
double rest_to_rest_s(double distance, const AxisBounds& limits);

/// The time model of [A]: at every one of `stops` the axes `first` to `last` (of kPathAxes) rest, between two of them
/// the slowest counts. `last` is one past.
double stop_time_s(std::span<const SevenAxes> axes, std::span<const std::size_t> stops, const AxesLimits& limits,
                   std::size_t first, std::size_t last);

/// The seven-axis model of [A] with the stages' limits: U and V rest at every one of `stops`, and the times between are
/// stretched each by itself where a stage's mean speed, or its second difference over the time, is beyond its limits.
/// A model only, as are both: the stages' jerk and the change of the times themselves are left out.
double dilated_stop_time_s(std::span<const SevenAxes> axes, std::span<const std::size_t> stops,
                           const AxesLimits& limits);

}  // namespace gravure::texture
