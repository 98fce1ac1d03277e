#include "least_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gravure::texture {
namespace {

/// The seconds that one limit alone asks for.
double seconds(LimitKind kind, double distance, const AxisBounds& limits) {
  constexpr double kFreeEnds = 12;  // d = j T^3 / 12 where the acceleration is free at both ends
  return kind == LimitKind::speed          ? distance / limits.speed
         : kind == LimitKind::acceleration ? 2 * std::sqrt(distance / limits.acceleration)
                                           : std::cbrt(kFreeEnds * distance / limits.jerk);
}

double bound_of(LimitKind kind, const AxisBounds& limits) {
  return kind == LimitKind::speed ? limits.speed : kind == LimitKind::acceleration ? limits.acceleration : limits.jerk;
}

std::array<double, kPathAxes.size()> places_of(const SevenAxes& at) {
  return {at.x_mm, at.y_mm, at.z_mm, at.a_rad, at.c_rad, at.u_mm, at.v_mm};
}

/// How far each axis is from one end of what it does to the other.
std::array<double, kPathAxes.size()> ranges_of(std::span<const SevenAxes> axes) {
  std::array<double, kPathAxes.size()> least = places_of(axes.front());
  std::array<double, kPathAxes.size()> most = least;
  for (const SevenAxes& each : axes) {
    const auto places = places_of(each);
    for (std::size_t k = 0; k < places.size(); ++k) {
      least[k] = std::min(least[k], places[k]);
      most[k] = std::max(most[k], places[k]);
    }
  }
  for (std::size_t k = 0; k < most.size(); ++k) {
    most[k] -= least[k];
  }
  return most;
}

std::string shown(std::size_t axis, LimitKind kind, double bound) {
  constexpr const char* kPer[] = {"s", "s^2", "s^3"};
  const char* per = kPer[static_cast<std::size_t>(kind)];
  const bool turns = kPathAxes[axis] == "A" || kPathAxes[axis] == "C";
  constexpr double kDegrees = 57.29577951308232;
  return turns ? fmt::format("{:.6g} deg/{} ({:.6g} rad/{})", bound * kDegrees, per, bound, per)
               : fmt::format("{:.6g} mm/{}", bound, per);
}

constexpr const char* kAdvice = "take a faster axis, a longer servo period or a shorter path";

}  // namespace

Result<void> check_least_time(const PathTimingRequest& request) {
  const double most_s = static_cast<double>(kMostPeriods) * request.servo_s;
  const auto ranges = ranges_of(request.axes);
  for (std::size_t axis = 0; axis < ranges.size(); ++axis) {
    for (const LimitKind kind : {LimitKind::speed, LimitKind::acceleration, LimitKind::jerk}) {
      const double time_s = seconds(kind, ranges[axis], request.limits[axis]);
      if (time_s > most_s) {
        return Error{
            ErrorCode::out_of_range,
            fmt::format("axis {}: {} {}: its {:.6g} {} take {:.3g} s at least, that is {:.3g} servo periods of "
                        "{:.6g} us; at most {} can be planned: {}",
                        kPathAxes[axis], limit_name(kind), shown(axis, kind, bound_of(kind, request.limits[axis])),
                        ranges[axis], axis == 3 || axis == 4 ? "rad" : "mm", time_s, time_s / request.servo_s,
                        request.servo_s * 1e6, kMostPeriods, kAdvice)};
      }
    }
  }
  return {};
}

Error too_long(double periods, double servo_s) {
  return {ErrorCode::out_of_range,
          fmt::format("the motion takes {:.3g} s or more, that is {:.3g} servo periods of {:.6g} us; at most {} can be "
                      "planned: {}",
                      periods * servo_s, periods, servo_s * 1e6, kMostPeriods, kAdvice)};
}

}  // namespace gravure::texture
