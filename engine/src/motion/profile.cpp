#include "gravure/motion/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gravure::motion {

State Profile::at(double time_s) const noexcept {
  if (!(time_s >= 0)) {
    return {0, velocity_mm_s[0], 0, 0};
  }
  if (time_s >= times_s[7]) {
    return {stroke_mm + end_velocity_mm_s * (time_s - times_s[7]), end_velocity_mm_s, 0, 0};
  }
  std::size_t k = 6;
  while (time_s < times_s[k]) {
    --k;
  }
  const double h = time_s - times_s[k];
  const double jerk = jerk_mm_s3[k];
  const double acceleration = acceleration_mm_s2[k];
  const double velocity = velocity_mm_s[k];
  return {position_mm[k] + h * (velocity + h * (acceleration / 2 + h * jerk / 6)),
          velocity + h * (acceleration + h * jerk / 2), acceleration + h * jerk, jerk};
}

Result<std::vector<Sample>> sample_profile(const Profile& profile, double update_us, std::size_t max_samples) {
  if (!(update_us > 0) || !std::isfinite(update_us)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("sample_profile: update_us = {}: must be a finite number above 0", update_us)};
  }
  const double update_s = update_us * 1e-6;
  const double updates = std::ceil(profile.access_time_s() / update_s - 1e-9);
  if (!(updates < static_cast<double>(max_samples))) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("sample_profile: update_us = {} makes {} samples of a move of {} s: at most {} are allowed; "
                    "take a longer update",
                    update_us, updates + 1, profile.access_time_s(), max_samples)};
  }
  std::vector<Sample> samples;
  const auto count = static_cast<std::size_t>(std::max(0.0, updates));
  samples.reserve(count + 1);
  for (std::size_t k = 0; k < count; ++k) {
    const double time_s = static_cast<double>(k) * update_s;
    samples.push_back({time_s, profile.at(time_s)});
  }
  const double end_s = profile.end_velocity_mm_s == 0 ? static_cast<double>(count) * update_s : profile.access_time_s();
  samples.push_back({end_s, {profile.stroke_mm, profile.end_velocity_mm_s, 0, 0}});
  return samples;
}

Profile slow_down(const Profile& profile, double factor) noexcept {
  Profile slow = profile;
  for (double& time_s : slow.times_s) {
    time_s *= factor;
  }
  for (std::size_t k = 0; k < 7; ++k) {
    slow.durations_s[k] *= factor;
    slow.velocity_mm_s[k] /= factor;
    slow.acceleration_mm_s2[k] /= factor * factor;
    slow.jerk_mm_s3[k] /= factor * factor * factor;
  }
  slow.end_velocity_mm_s /= factor;
  slow.peak_velocity_mm_s /= factor;
  slow.peak_acceleration_up_mm_s2 /= factor * factor;
  slow.peak_acceleration_down_mm_s2 /= factor * factor;
  return slow;
}

}  // namespace gravure::motion
