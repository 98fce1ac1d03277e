#include "path_limits.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace gravure {
namespace {

constexpr int kPlaces = 10;
constexpr double kLimitRounding = 1e-6;  // of a limit
constexpr double kStill = 1e-8;          // mm, degrees: what a cubic swings out where an axis comes to rest

bool turns(std::size_t axis) {
  return kPathAxes[axis] == "A" || kPathAxes[axis] == "C";
}

}  // namespace

PathLimits::PathLimits(const Plan& plan) : plan_(plan), periods_per_s_(to_double(plan.line.rate_hz)) {
  for (std::size_t axis = 0; axis < plan.path->axes.size(); ++axis) {
    const double degrees = turns(axis) ? 180 / std::numbers::pi : 1;
    units_per_count_[axis] = degrees / to_double(plan.path->axes[axis].counts_per_unit);
  }
}

void PathLimits::take(const PathWindow& window, std::int64_t line) {
  for (std::size_t axis = 0; axis < plan_.path->axes.size(); ++axis) {
    Extremes& seen = extremes_[axis];
    for (int place = 0; place <= kPlaces; ++place) {
      const double share = static_cast<double>(place) / kPlaces;
      const CubicMotion motion = axis_motion(window, axis, share);
      const std::array<double, kKinds> values = {-motion.position, motion.position, std::abs(motion.speed),
                                                 std::abs(motion.acceleration), std::abs(motion.jerk)};
      for (std::size_t kind = 0; kind < kKinds; ++kind) {
        if (seen[kind].when < 0 || values[kind] > seen[kind].value) {
          seen[kind] = {values[kind], static_cast<double>(line) + share};
        }
      }
    }
  }
}

std::vector<AxisUse> PathLimits::uses() const {
  std::vector<AxisUse> uses(plan_.path->axes.size());
  for (std::size_t axis = 0; axis < uses.size(); ++axis) {
    const Extremes& seen = extremes_[axis];
    const double unit = units_per_count_[axis];
    const double rate = periods_per_s_;
    uses[axis] = {-seen[kLeast].value * unit,
                  seen[kMost].value * unit,
                  seen[kSpeed].value * unit * rate,
                  seen[kAcceleration].value * unit * rate * rate,
                  seen[kJerk].value * unit * rate * rate * rate,
                  2 * unit * rate,
                  2 * unit * rate * rate,
                  4 * unit * rate * rate * rate};
  }
  return uses;
}

std::vector<std::string> PathLimits::violations() const {
  std::vector<std::string> found;
  const auto uses = this->uses();
  for (std::size_t axis = 0; axis < uses.size(); ++axis) {
    const PathAxisPlan& plan = plan_.path->axes[axis];
    const char* unit = turns(axis) ? "deg" : "mm";
    const auto hold = [&](const char* what, double value, const std::optional<Rational>& limit, double rounding,
                          const char* per, Kind kind) {
      if (!limit || value <= to_double(*limit) + std::abs(to_double(*limit)) * kLimitRounding + rounding) {
        return;
      }
      const double when = extremes_[axis][kind].when;
      found.push_back(fmt::format("axis {}: {} {:.9g} {}{} at {:.6f} s (line {}), allowed {:.9g}", kPathAxes[axis],
                                  what, kind == kLeast ? -value : value, unit, per, when / periods_per_s_,
                                  static_cast<std::int64_t>(when),
                                  kind == kLeast ? -to_double(*limit) : to_double(*limit)));
    };
    const auto negative = plan.least ? std::optional<Rational>(-*plan.least) : std::nullopt;
    hold("position", -uses[axis].least, negative, kStill, "", kLeast);
    hold("position", uses[axis].most, plan.most, kStill, "", kMost);
    hold("speed", uses[axis].max_speed, plan.limits.max_speed, uses[axis].speed_rounding, "/s", kSpeed);
    hold("acceleration", uses[axis].max_acceleration, plan.limits.max_acceleration, uses[axis].acceleration_rounding,
         "/s^2", kAcceleration);
    hold("jerk", uses[axis].max_jerk, plan.limits.max_jerk, uses[axis].jerk_rounding, "/s^3", kJerk);
  }
  return found;
}

}  // namespace gravure
