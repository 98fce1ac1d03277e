#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "gravure/pipeline/compile_path.hpp"
#include "gravure/pipeline/path_plan.hpp"
#include "sampled_motion.hpp"

namespace gravure::path_test {

/// 82 MHz, every 41st pulse, j = 2, 50 us: 100 slots of 82 ticks a line.
inline PathPlanRequest request(const Rational& pitch_um) {
  PathPlanRequest request;
  request.title = "path";
  request.laser.seed_hz = 82'000'000;
  request.laser.pulse_divider = 41;
  request.laser.max_pulse_on_demand_hz = 16'400'000;
  request.pulse_pitch_um = pitch_um;
  request.path.surface = "flat";
  request.path.texture = "line";
  return request;
}

/// From rest to rest along x in so many periods, as 10 s^3 - 15 s^4 + 6 s^5; C turns once, U waves.
inline std::vector<PathInstant> eased_line(double length_mm, int periods) {
  std::vector<PathInstant> instants;
  for (int i = 0; i <= periods; ++i) {
    const double s = static_cast<double>(i) / periods;
    const double share = s * s * s * (10 - 15 * s + 6 * s * s);
    PathInstant instant;
    instant.axes = {share * length_mm, -share, 3.5, 0.1 * share, 2 * std::numbers::pi * share, std::sin(7 * share), 0};
    instant.along_mm = share * length_mm;
    instants.push_back(instant);
  }
  return instants;
}

/// With a focus axis that may go from `least_mm` to `most_mm`.
inline PathPlanRequest with_focus_axis(PathPlanRequest request, int least_mm, int most_mm) {
  request.path.axes.resize(kPathAxes.size());
  request.path.axes.back().least = Rational(least_mm);
  request.path.axes.back().most = Rational(most_mm);
  return request;
}

/// At once at full speed.
inline std::vector<PathInstant> even_line(double mm_per_period, int periods) {
  std::vector<PathInstant> instants(static_cast<std::size_t>(periods) + 1);
  for (int i = 0; i <= periods; ++i) {
    PathInstant& instant = instants[static_cast<std::size_t>(i)];
    instant.along_mm = instant.axes[0] = mm_per_period * i;
  }
  return instants;
}

}  // namespace gravure::path_test
