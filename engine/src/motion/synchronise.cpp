#include "gravure/motion/synchronise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assemble.hpp"
#include "check_request.hpp"
#include "ramp.hpp"

namespace gravure::motion {
namespace {

/// A move that cruises at a chosen velocity, in the frame of its stroke.
class Cruise {
 public:
  explicit Cruise(const JerkRequest& request) noexcept
      : direction_(request.move.stroke_mm < 0 ? -1 : 1),
        stroke_(std::abs(request.move.stroke_mm)),
        start_(direction_ * request.move.start_velocity_mm_s),
        end_(direction_ * request.move.end_velocity_mm_s),
        up_(RampLaw::jerk_limited(request.move.a_up_mm_s2, request.jerk_up_mm_s3)),
        down_(RampLaw::jerk_limited(request.move.a_down_mm_s2, request.jerk_down_mm_s3)) {}

  double direction() const noexcept { return direction_; }
  /// What is left for the cruise when it runs at `velocity`.
  double distance_left(double velocity) const noexcept {
    return stroke_ - (start_ + velocity) / 2 * law(velocity - start_).duration_s(std::abs(velocity - start_)) -
           (velocity + end_) / 2 * law(end_ - velocity).duration_s(std::abs(end_ - velocity));
  }
  double duration_s(double velocity) const noexcept {
    return law(velocity - start_).duration_s(std::abs(velocity - start_)) +
           law(end_ - velocity).duration_s(std::abs(end_ - velocity)) + distance_left(velocity) / velocity;
  }
  Parts parts(double velocity) const noexcept {
    Parts parts;
    parts.first = law(velocity - start_).ramp(std::abs(velocity - start_));
    parts.second = law(end_ - velocity).ramp(std::abs(end_ - velocity));
    parts.first_sign = velocity >= start_ ? 1 : -1;
    parts.second_sign = end_ >= velocity ? 1 : -1;
    parts.cruise_s = std::max(0.0, distance_left(velocity) / velocity);
    parts.start_velocity = start_;
    parts.peak_velocity = velocity;
    return parts;
  }

 private:
  const RampLaw& law(double change) const noexcept { return change >= 0 ? up_ : down_; }
  double direction_;
  double stroke_;
  double start_;
  double end_;
  RampLaw up_;
  RampLaw down_;
};

bool rest_to_rest(const Move& move) noexcept {
  return move.start_velocity_mm_s == 0 && move.end_velocity_mm_s == 0;
}

Error cannot_last(const JerkRequest& request, double shortest_s, double access_time_s) {
  return Error{
      ErrorCode::out_of_range,
      fmt::format("motion: a move of stroke_mm = {} from {} to {} mm/s takes {} s at least and cannot be made to "
                  "last {} s without turning back; bring its ends nearer to rest",
                  request.move.stroke_mm, request.move.start_velocity_mm_s, request.move.end_velocity_mm_s, shortest_s,
                  access_time_s)};
}

/// Peaks of both signs summarise which acceleration was used along and against the move.
void set_peaks(Profile& profile, const Parts& parts) noexcept {
  profile.peak_acceleration_up_mm_s2 = 0;
  profile.peak_acceleration_down_mm_s2 = 0;
  for (const auto& [ramp, sign] :
       {std::pair(&parts.first, parts.first_sign), std::pair(&parts.second, parts.second_sign)}) {
    double& peak = sign > 0 ? profile.peak_acceleration_up_mm_s2 : profile.peak_acceleration_down_mm_s2;
    peak = std::max(peak, ramp->acceleration);
  }
}

/// Slower cruise velocities take longer without bound as long as the stroke is longer than stopping and starting again.
Result<Profile> cruise_slower(const JerkRequest& request, const Profile& shortest, double access_time_s) {
  const Cruise cruise(request);
  double fast = cruise.direction() * shortest.peak_velocity_mm_s;
  double slow = 0;
  if (!(cruise.distance_left(0) * fast > 0)) {
    return cannot_last(request, shortest.access_time_s(), access_time_s);
  }
  for (int step = 0; step < 200; ++step) {
    const double middle = slow + (fast - slow) / 2;
    if (middle == slow || middle == fast) {
      break;
    }
    const bool too_fast = cruise.distance_left(middle) / middle >= 0 && cruise.duration_s(middle) < access_time_s;
    // A cruise that would have to run backwards belongs to velocities beyond the shortest move's: slow down.
    const bool beyond = cruise.distance_left(middle) / middle < 0;
    (too_fast || beyond ? fast : slow) = middle;
  }
  const Parts parts = cruise.parts(slow);
  Profile profile = assemble(parts, cruise.direction(), request.move.stroke_mm, request.move.end_velocity_mm_s);
  set_peaks(profile, parts);
  if (std::abs(profile.access_time_s() - access_time_s) > 1e-9 * access_time_s) {
    return cannot_last(request, shortest.access_time_s(), access_time_s);
  }
  return profile;
}

}  // namespace

Result<Profile> plan_profile_lasting(const JerkRequest& request, double access_time_s) {
  GRAVURE_TRY(const Profile shortest, plan_profile(request));
  GRAVURE_CHECK(check_range("access_time_s", access_time_s, shortest.access_time_s(), 1e15));
  Profile profile = shortest;
  if (access_time_s > shortest.access_time_s()) {
    if (shortest.access_time_s() == 0 && rest_to_rest(request.move)) {
      profile.durations_s[3] = access_time_s;  // an axis that stays only waits
      std::fill(profile.times_s.begin() + 4, profile.times_s.end(), access_time_s);
    } else if (rest_to_rest(request.move)) {
      profile = slow_down(shortest, access_time_s / shortest.access_time_s());
    } else {
      GRAVURE_TRY(profile, cruise_slower(request, shortest, access_time_s));
    }
  }
  profile.times_s[7] = access_time_s;
  profile.reduced.velocity = std::abs(profile.peak_velocity_mm_s) < request.move.v_max_mm_s;
  profile.reduced.acceleration_up = profile.peak_acceleration_up_mm_s2 < request.move.a_up_mm_s2;
  profile.reduced.acceleration_down = profile.peak_acceleration_down_mm_s2 < request.move.a_down_mm_s2;
  return profile;
}

Result<SynchronisedMove> synchronise(std::span<const JerkRequest> axes) {
  if (axes.empty()) {
    return Error{ErrorCode::bad_argument, "motion: synchronise: no axis given; give at least one"};
  }
  SynchronisedMove move;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    GRAVURE_TRY(const Profile shortest, plan_profile(axes[axis]));
    if (shortest.access_time_s() > move.access_time_s) {
      move.access_time_s = shortest.access_time_s();
      move.slowest_axis = axis;
    }
  }
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    auto profile = plan_profile_lasting(axes[axis], move.access_time_s);
    if (!profile) {
      return Error{profile.error().code, fmt::format("axis {}: {}", axis, profile.error().message)};
    }
    move.axes.push_back(std::move(profile).value());
  }
  return move;
}

}  // namespace gravure::motion
