#pragma once

#include "gravure/motion/profile.hpp"
#include "ramp.hpp"

namespace gravure::motion {

/// The parts of a move in the frame of its stroke: two ramps, each with the sign of its velocity change, and a cruise.
struct Parts {
  Ramp first;
  Ramp second;
  double first_sign = 1;  ///< +1 where the first ramp accelerates along the move
  double second_sign = -1;
  double cruise_s = 0;
  double start_velocity = 0;
  double peak_velocity = 0;
};

/// Segment constants by integrating the parts; `direction` (+1 or -1) turns them into the machine's frame.
/// Sets everything of the profile except `reduced`.
Profile assemble(const Parts& parts, double direction, double stroke, double end_velocity) noexcept;

}  // namespace gravure::motion
