#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gravure/core/path_expand.hpp"
#include "gravure/core/plan.hpp"
#include "gravure/twin/verify_path.hpp"

namespace gravure {

/// Holds every period of a path against the limits of its axes, at ten places each.
class PathLimits {
 public:
  explicit PathLimits(const Plan& plan);
  void take(const PathWindow& window, std::int64_t line);
  std::vector<AxisUse> uses() const;
  /// What is beyond its limit, each once, with the largest value and where it is.
  std::vector<std::string> violations() const;

 private:
  /// A figure of an axis: position up and down, speed, acceleration, jerk.
  struct Extreme {
    double value = 0;
    double when = -1;  ///< periods since the begin of the path; below 0: nothing seen
  };
  enum Kind : std::size_t { kLeast, kMost, kSpeed, kAcceleration, kJerk, kKinds };
  using Extremes = std::array<Extreme, kKinds>;

  const Plan& plan_;
  std::array<double, kPathAxes.size()> units_per_count_{};
  double periods_per_s_;
  std::array<Extremes, kPathAxes.size()> extremes_;
};

}  // namespace gravure
