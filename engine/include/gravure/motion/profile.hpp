#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::motion {

/// Where an axis is at one instant. Lengths are named mm, the machine's unit; every function of this library works in
/// any length unit that is used throughout.
struct State {
  double position_mm = 0;
  double velocity_mm_s = 0;
  double acceleration_mm_s2 = 0;
  double jerk_mm_s3 = 0;
};

/// Which limits of the request the profile does not reach, because another one (or the stroke) decides.
struct Reduced {
  bool velocity = false;
  bool acceleration_up = false;
  bool acceleration_down = false;
  bool acceleration() const noexcept { return acceleration_up || acceleration_down; }
};

/// A jerk-limited move in seven segments: ramp (jerk, constant acceleration, jerk), cruise, ramp; [C1] eqs 1 to 7.
///
/// Segment k runs from times_s[k] to times_s[k + 1] and starts with the k-th constants; inside it the state is the
/// Taylor polynomial of its own start. A segment of no duration has jerk 0; the acceleration constants then jump
/// (S factor 0, the trapezoid). Made by plan_profile() and its relatives, which guarantee that times never fall and
/// that the polynomials meet.
struct Profile {
  std::array<double, 8> times_s{};
  std::array<double, 7> durations_s{};  ///< kept beside the times: a short ramp after a long cruise loses digits there
  std::array<double, 7> jerk_mm_s3{};
  std::array<double, 7> acceleration_mm_s2{};  ///< "Ca" of [C1]
  std::array<double, 7> velocity_mm_s{};       ///< "Cv" of [C1]
  std::array<double, 7> position_mm{};         ///< "Cx" of [C1]
  double stroke_mm = 0;                        ///< the target, exactly as asked for
  double end_velocity_mm_s = 0;
  double peak_velocity_mm_s = 0;            ///< of the cruise, signed; it may last no time
  double peak_acceleration_up_mm_s2 = 0;    ///< magnitude reached along the move's direction
  double peak_acceleration_down_mm_s2 = 0;  ///< magnitude reached against it
  Reduced reduced;

  double access_time_s() const noexcept { return times_s[7]; }
  /// The state at any time: at rest conditions of the start before 0; from the end on exactly the target, moving on
  /// with the end velocity.
  State at(double time_s) const noexcept;
};

struct Sample {
  double time_s = 0;
  State state;
};

/// The profile at 0, update, 2 update ... The last sample is the exact target: on the first update at or after the end
/// for a move that ends at rest, at the access time itself for one that ends moving.
/// Fails with out_of_range for an update that is not positive or makes more than `max_samples`.
Result<std::vector<Sample>> sample_profile(const Profile& profile, double update_us,
                                           std::size_t max_samples = 10'000'000);

/// The same path `factor` >= 1 times slower: velocities fall by factor, accelerations by its square, jerks by its cube.
/// For moves from rest to rest; the ends of any other would change speed.
Profile slow_down(const Profile& profile, double factor) noexcept;

}  // namespace gravure::motion
