#pragma once

#include "ramp.hpp"

namespace gravure::motion {

/// A move in the frame where it goes to a higher velocity first: start -> peak with `first`, then peak -> end with
/// `second`; peak >= both ends.
struct PeakProblem {
  double stroke = 0;
  double start_velocity = 0;
  double end_velocity = 0;
  double v_max = 0;
  RampLaw first;
  RampLaw second;
};

struct Peak {
  double rise = 0;  ///< of the peak above the higher end velocity; kept apart so that a tiny one is not lost
  double cruise_s = 0;
};

/// Distance of the two ramps where the peak lies `rise` >= 0 above the higher end velocity.
double ramps_distance(const PeakProblem& problem, double rise) noexcept;
double ramps_duration_s(const PeakProblem& problem, double rise) noexcept;

/// The higher of the two end velocities.
double higher_end(const PeakProblem& problem) noexcept;

/// The peak of the shortest move; needs stroke >= ramps_distance(problem, 0) and v_max > 0 or the stroke within reach.
Peak solve_peak(const PeakProblem& problem) noexcept;

}  // namespace gravure::motion
