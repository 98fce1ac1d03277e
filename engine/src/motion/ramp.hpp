#pragma once

namespace gravure::motion {

/// One change of velocity: two jerk segments around a piece of constant acceleration.
struct Ramp {
  double jerk_time_s = 0;
  double constant_time_s = 0;
  double acceleration = 0;  ///< magnitude
  double jerk = 0;          ///< magnitude; 0 where the jerk segments last no time
  double duration_s() const noexcept { return 2 * jerk_time_s + constant_time_s; }
};

/// How long a change of velocity takes under the limits of one direction.
class RampLaw {
 public:
  static RampLaw jerk_limited(double acceleration, double jerk) noexcept;
  static RampLaw fixed_jerk_time(double acceleration, double jerk_time_s) noexcept;

  /// `change` >= 0; 0 gives the ramp of no duration.
  Ramp ramp(double change) const noexcept;
  double duration_s(double change) const noexcept;
  /// The change from which on the acceleration limit is reached.
  double full_change() const noexcept { return full_change_; }
  double acceleration() const noexcept { return acceleration_; }
  double jerk() const noexcept { return jerk_; }
  double jerk_time_s() const noexcept { return jerk_time_s_; }
  bool fixed() const noexcept { return fixed_; }

 private:
  double acceleration_ = 0;
  double jerk_ = 0;         ///< jerk-limited only
  double jerk_time_s_ = 0;  ///< of a full ramp
  double full_change_ = 0;
  bool fixed_ = false;
};

}  // namespace gravure::motion
