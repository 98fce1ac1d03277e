#include "assemble.hpp"

#include <algorithm>

namespace gravure::motion {
namespace {

struct Cursor {
  Profile profile;
  std::size_t segment = 0;
  double time_s = 0;
  double velocity = 0;
  double position = 0;

  void push(double duration_s, double acceleration, double jerk) noexcept {
    profile.times_s[segment] = time_s;
    profile.durations_s[segment] = duration_s;
    profile.jerk_mm_s3[segment] = jerk;
    profile.acceleration_mm_s2[segment] = acceleration;
    profile.velocity_mm_s[segment] = velocity;
    profile.position_mm[segment] = position;
    position += duration_s * (velocity + duration_s * (acceleration / 2 + duration_s * jerk / 6));
    velocity += duration_s * (acceleration + duration_s * jerk / 2);
    time_s += duration_s;
    ++segment;
  }
};

void push_ramp(Cursor& cursor, const Ramp& ramp, double sign) noexcept {
  const double top = sign * ramp.acceleration;
  const double jerk = sign * ramp.jerk;
  cursor.push(ramp.jerk_time_s, 0, jerk);
  cursor.push(ramp.constant_time_s, top, 0);
  cursor.push(ramp.jerk_time_s, top, -jerk);
}

/// Without -0, which would print as "-0".
double plain(double value) noexcept {
  return value + 0.0;
}

}  // namespace

Profile assemble(const Parts& parts, double direction, double stroke, double end_velocity) noexcept {
  Cursor cursor;
  cursor.velocity = direction * parts.start_velocity;
  push_ramp(cursor, parts.first, direction * parts.first_sign);
  cursor.velocity = direction * parts.peak_velocity;  // known better than the sum of the segments
  cursor.push(parts.cruise_s, 0, 0);
  push_ramp(cursor, parts.second, direction * parts.second_sign);
  Profile& profile = cursor.profile;
  profile.times_s[7] = cursor.time_s;
  for (auto* constants :
       {&profile.jerk_mm_s3, &profile.acceleration_mm_s2, &profile.velocity_mm_s, &profile.position_mm}) {
    std::transform(constants->begin(), constants->end(), constants->begin(), plain);
  }
  profile.stroke_mm = stroke;
  profile.end_velocity_mm_s = end_velocity;
  profile.peak_velocity_mm_s = plain(direction * parts.peak_velocity);
  const bool up_first = parts.first_sign > 0;
  profile.peak_acceleration_up_mm_s2 = (up_first ? parts.first : parts.second).acceleration;
  profile.peak_acceleration_down_mm_s2 = (up_first ? parts.second : parts.first).acceleration;
  return profile;
}

}  // namespace gravure::motion
