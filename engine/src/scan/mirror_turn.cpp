#include "mirror_turn.hpp"

#include <algorithm>
#include <cmath>

#include "gravure/motion/plan_profile.hpp"

namespace gravure::scan {
namespace {

constexpr double kUnlimited = 1e20;   ///< the motion library takes up to 1e21
constexpr double kLeastLoad = 1e-11;  ///< and from 1e-12
constexpr double kUnlimitedSpeed = 1e15;
constexpr int kHalvings = 200;

/// The shapes of acceleration and jerk that a turn may have: multiples of this pair.
struct Load {
  double acceleration_mm_s2;
  double jerk_mm_s3;
};

class Turn {
 public:
  Turn(const MirrorState& from, const MirrorState& to, const MirrorLimits& limits)
      : stroke_(to.position_mm - from.position_mm),
        start_(from.speed_mm_s),
        end_(to.speed_mm_s),
        v_max_(limits.max_speed_mm_s.value_or(kUnlimitedSpeed)) {}

  Result<motion::Profile> under(const Load& load, double share) const {
    const double acceleration = load.acceleration_mm_s2 * share;
    const double jerk = load.jerk_mm_s3 * share;
    return motion::plan_profile(
        motion::JerkRequest{{stroke_, v_max_, acceleration, acceleration, start_, end_}, jerk, jerk});
  }

  /// The smallest share of the load whose shortest profile does not last longer; halving in logarithms, since the share
  /// may be anything.
  Result<double> least_share(const Load& load, double lasts_s) const {
    double low = kLeastLoad / std::min(load.acceleration_mm_s2, load.jerk_mm_s3);
    double high = kUnlimited / std::max(load.acceleration_mm_s2, load.jerk_mm_s3);
    for (int step = 0; step < kHalvings; ++step) {
      const double middle = std::sqrt(low) * std::sqrt(high);
      if (!(middle > low && middle < high)) {
        break;
      }
      GRAVURE_TRY(const motion::Profile profile, under(load, middle));
      (profile.access_time_s() <= lasts_s ? high : low) = middle;
    }
    return high;
  }

 private:
  double stroke_;
  double start_;
  double end_;
  double v_max_;
};

/// Walks the profile for its extremes; positions have theirs where the speed changes sign.
void summarise(MirrorTurn& turn) {
  const motion::Profile& profile = turn.profile;
  turn.peak_acceleration_mm_s2 = std::max(profile.peak_acceleration_up_mm_s2, profile.peak_acceleration_down_mm_s2);
  turn.least_mm = turn.most_mm = turn.start_mm;
  const auto visit = [&turn, &profile](double time_s) {
    const motion::State state = profile.at(time_s);
    turn.peak_speed_mm_s = std::max(turn.peak_speed_mm_s, std::abs(state.velocity_mm_s));
    turn.least_mm = std::min(turn.least_mm, turn.start_mm + state.position_mm);
    turn.most_mm = std::max(turn.most_mm, turn.start_mm + state.position_mm);
  };
  for (std::size_t k = 0; k < 7; ++k) {
    turn.peak_jerk_mm_s3 = std::max(turn.peak_jerk_mm_s3, std::abs(profile.jerk_mm_s3[k]));
    double low = profile.times_s[k];
    double high = profile.times_s[k + 1];
    visit(low);
    visit(high);
    if (profile.at(low).velocity_mm_s * profile.at(high).velocity_mm_s < 0) {
      const bool is_falling = profile.at(low).velocity_mm_s > 0;
      for (int step = 0; step < 60; ++step) {
        const double middle = low + (high - low) / 2;
        ((profile.at(middle).velocity_mm_s > 0) == is_falling ? low : high) = middle;
      }
      visit(low);
    }
  }
}

Load load_of(const MirrorLimits& limits, double lasts_s, double steepness) {
  const double per_s = 4 * steepness / lasts_s;  // jerk a unit of acceleration
  if (limits.max_acceleration_mm_s2) {
    return {*limits.max_acceleration_mm_s2, limits.max_jerk_mm_s3.value_or(*limits.max_acceleration_mm_s2 * per_s)};
  }
  return limits.max_jerk_mm_s3 ? Load{*limits.max_jerk_mm_s3 / per_s, *limits.max_jerk_mm_s3} : Load{1, per_s};
}

}  // namespace

Result<MirrorTurn> plan_mirror_turn(const MirrorState& from, const MirrorState& to, double lasts_s,
                                    const MirrorLimits& limits) {
  MirrorTurn turn;
  turn.start_mm = from.position_mm;
  turn.start_mm_s = from.speed_mm_s;
  turn.end_mm_s = to.speed_mm_s;
  turn.lasts_s = lasts_s;
  const Turn mirror(from, to, limits);
  const bool is_limited = limits.max_acceleration_mm_s2 || limits.max_jerk_mm_s3;
  if (is_limited || limits.max_speed_mm_s) {
    const Load most{limits.max_acceleration_mm_s2.value_or(kUnlimited), limits.max_jerk_mm_s3.value_or(kUnlimited)};
    GRAVURE_TRY(const motion::Profile shortest, mirror.under(most, 1));
    turn.shortest_s = shortest.access_time_s();
  }
  if (!(lasts_s > 0) || lasts_s < turn.shortest_s) {
    return turn;
  }
  // A share above 1 means that the jerk chosen for want of a limit is too gentle for the acceleration (or the other way
  // round): steeper, until both fit.
  const bool is_half_limited = is_limited && !(limits.max_acceleration_mm_s2 && limits.max_jerk_mm_s3);
  double steepness = 1;
  Load load = load_of(limits, lasts_s, steepness);
  GRAVURE_TRY(double share, mirror.least_share(load, lasts_s));
  for (int step = 0; is_half_limited && share > 1 && step < 40; ++step) {
    steepness *= limits.max_acceleration_mm_s2 ? 4 : 0.25;
    load = load_of(limits, lasts_s, steepness);
    GRAVURE_TRY(share, mirror.least_share(load, lasts_s));
  }
  GRAVURE_TRY(turn.profile, mirror.under(load, share));
  summarise(turn);
  return turn;
}

}  // namespace gravure::scan
