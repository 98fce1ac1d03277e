#include "ramp.hpp"

#include <algorithm>
#include <cmath>

namespace gravure::motion {

RampLaw RampLaw::jerk_limited(double acceleration, double jerk) noexcept {
  RampLaw law;
  law.acceleration_ = acceleration;
  law.jerk_ = jerk;
  law.jerk_time_s_ = acceleration / jerk;
  law.full_change_ = acceleration * law.jerk_time_s_;
  return law;
}

RampLaw RampLaw::fixed_jerk_time(double acceleration, double jerk_time_s) noexcept {
  RampLaw law;
  law.acceleration_ = acceleration;
  law.jerk_time_s_ = jerk_time_s;
  law.full_change_ = acceleration * jerk_time_s;
  law.fixed_ = true;
  return law;
}

Ramp RampLaw::ramp(double change) const noexcept {
  if (change <= 0) {
    return {};
  }
  if (change < full_change_) {
    if (fixed_) {
      const double reached = change / jerk_time_s_;
      return {jerk_time_s_, 0, reached, reached / jerk_time_s_};
    }
    const double jerk_time = std::sqrt(change / jerk_);
    return {jerk_time, 0, jerk_ * jerk_time, jerk_};
  }
  const double constant = std::max(0.0, change / acceleration_ - jerk_time_s_);
  const double jerk = jerk_time_s_ > 0 ? acceleration_ / jerk_time_s_ : 0;
  return {jerk_time_s_, constant, acceleration_, jerk};
}

double RampLaw::duration_s(double change) const noexcept {
  if (change <= 0) {
    return 0;
  }
  if (change < full_change_) {
    return 2 * (fixed_ ? jerk_time_s_ : std::sqrt(change / jerk_));
  }
  return change / acceleration_ + jerk_time_s_;
}

}  // namespace gravure::motion
