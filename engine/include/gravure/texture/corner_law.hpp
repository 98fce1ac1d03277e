#pragma once

#include "gravure/core/error.hpp"

namespace gravure::texture {

/// What a Gaussian split leaves to galvo and stages at a corner of an infinite path run at constant speed; exact.
/// With u = 2 sin(turn / 2) it is u v / (2 pi)^(1/2) times sigma (in time) for the galvo and by sigma for the stages.
struct CornerDemand {
  double throw_mm = 0;            ///< galvo, at the corner
  double acceleration_mm_s2 = 0;  ///< stages, at the corner
  double jerk_mm_s3 = 0;          ///< stages, one sigma before and after it
};

/// `sigma_mm` of arc length.
CornerDemand corner_demand(double turn_rad, double speed_mm_s, double sigma_mm);

/// The fastest a corner can be run with any sigma at all: throw times acceleration is u^2 v^2 / (2 pi), whatever sigma.
/// out_of_range for arguments that are not above 0 (the turn: not from 0 to pi). Infinite for no turn.
Result<double> corner_feed_limit_mm_s(double turn_rad, double most_throw_mm, double most_acceleration_mm_s2);

/// The fastest a corner can be run with that sigma, by what stages can: where acceleration or jerk of corner_demand()
/// reaches the limit. All above 0; infinite for no turn.
double corner_speed_mm_s(double turn_rad, double sigma_mm, double most_acceleration_mm_s2, double most_jerk_mm_s3);

/// The sigma at which both limits are reached at that feed.
Result<double> corner_sigma_mm(double turn_rad, double most_throw_mm);

/// What a Gaussian leaves to the galvo of a sine of `amplitude_mm` with `wavelength_mm` of arc length.
double sine_throw_mm(double amplitude_mm, double wavelength_mm, double sigma_mm);

}  // namespace gravure::texture
