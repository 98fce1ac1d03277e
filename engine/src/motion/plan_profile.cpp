#include "gravure/motion/plan_profile.hpp"

#include <fmt/format.h>

#include <cmath>

#include "assemble.hpp"
#include "check_request.hpp"
#include "peak_velocity.hpp"

namespace gravure::motion {
namespace {

/// A move with velocity bounds of its own for both senses, as the frame of a moving target needs them.
struct BoundedMove {
  double stroke = 0;
  double start_velocity = 0;
  double end_velocity = 0;
  double v_max_forward = 0;   ///< along +
  double v_max_backward = 0;  ///< along -, as a magnitude
};

/// The peak problem of a move that rises (or, mirrored, dips) from its ends.
PeakProblem peak_problem(const BoundedMove& move, double side, const RampLaw& up, const RampLaw& down) noexcept {
  PeakProblem problem;
  problem.stroke = side * move.stroke;
  problem.start_velocity = side * move.start_velocity;
  problem.end_velocity = side * move.end_velocity;
  problem.v_max = side > 0 ? move.v_max_forward : move.v_max_backward;
  problem.first = side > 0 ? up : down;
  problem.second = side > 0 ? down : up;
  return problem;
}

/// Both ramp laws of the side: +1 where the peak lies above both ends, -1 where it lies below.
Parts plan_parts(const BoundedMove& move, const RampLaw& up, const RampLaw& down) noexcept {
  const PeakProblem rising = peak_problem(move, 1, up, down);
  const bool rises = rising.stroke >= ramps_distance(rising, 0);
  // The direct ramp may run either way; seen from below it is the same one, so both problems share it.
  const double side = rises ? 1 : -1;
  const PeakProblem problem = rises ? rising : peak_problem(move, -1, up, down);
  const Peak peak = solve_peak(problem);
  Parts parts;
  parts.first = problem.first.ramp(higher_end(problem) - problem.start_velocity + peak.rise);
  parts.second = problem.second.ramp(higher_end(problem) - problem.end_velocity + peak.rise);
  parts.first_sign = side;
  parts.second_sign = -side;
  parts.cruise_s = peak.cruise_s;
  parts.start_velocity = move.start_velocity;
  parts.peak_velocity = side * (higher_end(problem) + peak.rise);
  return parts;
}

double direction_of(double stroke) noexcept {
  return stroke < 0 ? -1 : 1;
}

Profile plan(const Move& move, const RampLaw& up, const RampLaw& down, double target_velocity) noexcept {
  const double direction = direction_of(move.stroke_mm);
  const double drift = direction * target_velocity;
  const BoundedMove bounded{std::abs(move.stroke_mm), direction * move.start_velocity_mm_s - drift,
                            direction * move.end_velocity_mm_s, move.v_max_mm_s - drift, move.v_max_mm_s + drift};
  const Parts parts = plan_parts(bounded, up, down);
  Profile profile = assemble(parts, direction, move.stroke_mm, move.end_velocity_mm_s);
  const double cruise = std::abs(profile.peak_velocity_mm_s + target_velocity);
  profile.reduced.velocity = cruise < move.v_max_mm_s;
  profile.reduced.acceleration_up = profile.peak_acceleration_up_mm_s2 < move.a_up_mm_s2;
  profile.reduced.acceleration_down = profile.peak_acceleration_down_mm_s2 < move.a_down_mm_s2;
  return profile;
}

}  // namespace

Result<Profile> plan_profile(const SFactorRequest& request) {
  GRAVURE_CHECK(check_request(request));
  const double jerk_time_s = request.s_factor * request.update_us * 1e-6;
  return plan(request.move, RampLaw::fixed_jerk_time(request.move.a_up_mm_s2, jerk_time_s),
              RampLaw::fixed_jerk_time(request.move.a_down_mm_s2, jerk_time_s), 0);
}

Result<Profile> plan_profile(const JerkRequest& request) {
  GRAVURE_CHECK(check_request(request));
  return plan(request.move, RampLaw::jerk_limited(request.move.a_up_mm_s2, request.jerk_up_mm_s3),
              RampLaw::jerk_limited(request.move.a_down_mm_s2, request.jerk_down_mm_s3), 0);
}

Result<Profile> plan_rendezvous(const JerkRequest& request, double target_velocity_mm_s) {
  GRAVURE_CHECK(check_request(request));
  const double v_max = request.move.v_max_mm_s;
  if (!(std::abs(target_velocity_mm_s) < v_max)) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("motion: target_velocity_mm_s = {}: must be slower than v_max_mm_s = {}, else it cannot be met",
                    target_velocity_mm_s, v_max)};
  }
  GRAVURE_CHECK(check_range("end_velocity_mm_s (relative to the target)", request.move.end_velocity_mm_s, 0, 0));
  Profile profile =
      plan(request.move, RampLaw::jerk_limited(request.move.a_up_mm_s2, request.jerk_up_mm_s3),
           RampLaw::jerk_limited(request.move.a_down_mm_s2, request.jerk_down_mm_s3), target_velocity_mm_s);
  // Back into the machine's frame: velocities shift, accelerations stay.
  for (std::size_t k = 0; k < 7; ++k) {
    profile.velocity_mm_s[k] += target_velocity_mm_s;
    profile.position_mm[k] += target_velocity_mm_s * profile.times_s[k];
  }
  profile.stroke_mm += target_velocity_mm_s * profile.access_time_s();
  profile.end_velocity_mm_s = target_velocity_mm_s;
  profile.peak_velocity_mm_s += target_velocity_mm_s;
  return profile;
}

}  // namespace gravure::motion
