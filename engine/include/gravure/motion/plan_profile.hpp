#pragma once

#include "gravure/motion/profile.hpp"

namespace gravure::motion {

/// What is common to every move of one axis. "Up" limits hold for acceleration along the move (the sign of the stroke),
/// "down" limits for acceleration against it, whichever comes first. Ends have no acceleration.
struct Move {
  double stroke_mm = 0;
  double v_max_mm_s = 0;           ///< > 0
  double a_up_mm_s2 = 0;           ///< > 0
  double a_down_mm_s2 = 0;         ///< > 0
  double start_velocity_mm_s = 0;  ///< signed like the stroke; at most v_max
  double end_velocity_mm_s = 0;
};

/// The published form [C1]: every jerk segment lasts tj = s_factor controller updates.
struct SFactorRequest {
  Move move;
  double s_factor = 0;     ///< >= 0; 0 is the trapezoid
  double update_us = 250;  ///< > 0
};

/// The time-optimal form: jerk limits, so short ramps have short jerk segments.
struct JerkRequest {
  Move move;
  double jerk_up_mm_s3 = 0;    ///< > 0, while the acceleration is along the move
  double jerk_down_mm_s3 = 0;  ///< > 0, while it is against the move
};

/// The profile of [C1] with its missing policy. A ramp of velocity change u takes max(u / a, tj) + tj, so a ramp too
/// short for tj lowers its acceleration to u / tj; when the cruise would last less than nothing the velocity is lowered
/// until it lasts 0 ([C1] states only when this is needed). `reduced` says what gave way.
/// Fails with out_of_range for values that are not finite or outside their range.
Result<Profile> plan_profile(const SFactorRequest& request);

/// The shortest profile under the limits. The branch is chosen by comparing the stroke with the distances at the branch
/// points and the root is held inside its branch, so nothing can fail within rounding of one.
Result<Profile> plan_profile(const JerkRequest& request);

/// Meets a target that is `stroke_mm` away at the start and moves with `target_velocity_mm_s`, and ends moving with it
/// (end_velocity_mm_s of the move must be 0: it is relative to the target). Limits hold in the machine's frame.
/// Fails with out_of_range where the target is as fast as v_max.
Result<Profile> plan_rendezvous(const JerkRequest& request, double target_velocity_mm_s);

}  // namespace gravure::motion
