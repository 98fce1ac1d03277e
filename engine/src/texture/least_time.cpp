#include "least_time.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "path_axes.hpp"

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

/// The ways of an axis from turn to turn.
std::vector<double> ways_of(std::span<const SevenAxes> axes, std::size_t axis) {
  constexpr double kRounding = 1e-9;  // mm or rad
  std::vector<double> ways;
  double from = values_of(axes.front())[axis];
  double last = from;
  const auto end_way = [&] {
    if (std::abs(last - from) > kRounding) {
      ways.push_back(std::abs(last - from));
    }
    from = last;
  };
  for (const SevenAxes& each : axes) {
    const double at = values_of(each)[axis];
    if ((at - last) * (last - from) < 0) {
      end_way();
    }
    last = at;
  }
  end_way();
  return ways;
}

std::string shown(std::size_t axis, LimitKind kind, double bound) {
  constexpr const char* kPer[] = {"s", "s^2", "s^3"};
  const char* per = kPer[static_cast<std::size_t>(kind)];
  const bool turns = kPathAxes[axis] == "A" || kPathAxes[axis] == "C";
  constexpr double kDegrees = 57.29577951308232;
  return turns ? fmt::format("{:.6g} deg/{} ({:.6g} rad/{})", bound * kDegrees, per, bound, per)
               : fmt::format("{:.6g} mm/{}", bound, per);
}

constexpr double kUs = 1e6;
constexpr const char* kAdvice = "take a faster axis, a longer servo period or a shorter path";

}  // namespace

Result<void> check_least_time(const PathTimingRequest& request) {
  const double most_s = static_cast<double>(kMostPeriods) * request.servo_s;
  for (std::size_t axis = 0; axis < request.limits.size(); ++axis) {
    const std::vector<double> ways = ways_of(request.axes, axis);
    const double share = axis < kStageAxes ? 1 : 0.5;
    for (const LimitKind kind : {LimitKind::speed, LimitKind::acceleration, LimitKind::jerk}) {
      double time_s = 0;
      for (const double way : ways) {
        time_s += share * seconds(kind, way, request.limits[axis]);
      }
      if (time_s > most_s) {
        return Error{
            ErrorCode::out_of_range,
            fmt::format("axis {}: {} {}: to and fro it takes {:.3g} s at least, that is {:.3g} servo periods "
                        "of {:.6g} us; at most {} can be planned: {}",
                        kPathAxes[axis], limit_name(kind), shown(axis, kind, bound_of(kind, request.limits[axis])),
                        time_s, time_s / request.servo_s, request.servo_s * kUs, kMostPeriods, kAdvice)};
      }
    }
  }
  return {};
}

Error too_long(double periods, double servo_s) {
  return {ErrorCode::out_of_range,
          fmt::format("the motion takes {:.3g} s or more, that is {:.3g} servo periods of {:.6g} us; at most {} can be "
                      "planned: {}",
                      periods * servo_s, periods, servo_s * kUs, kMostPeriods, kAdvice)};
}

}  // namespace gravure::texture
