#include "slow_stages.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "run_motion.hpp"

namespace gravure::texture {
namespace {

/// Stages and their derivatives by time.
struct StageRates {
  StageValues speed{};
  StageValues acceleration{};
  StageValues jerk{};
};

StageRates rates(const StageState& at, const PlaceState& place) {
  StageRates r;
  const double v = place.speed;
  for (std::size_t k = 0; k < kStageAxes; ++k) {
    r.speed[k] = at.first[k] * v;
    r.acceleration[k] = at.second[k] * v * v + at.first[k] * place.acceleration;
    r.jerk[k] = at.third[k] * v * v * v + 3 * at.second[k] * v * place.acceleration + at.first[k] * place.jerk;
  }
  return r;
}

struct Need {
  double factor = 0;  ///< how much slower; up to 1: within limits
  std::size_t axis = 0;
};

/// Whether all is within a share of the limits, which is so nearly everywhere: no roots for that.
bool within(const AxesLimits& limits, const StageRates& r, double share) {
  bool kept = true;
  for (std::size_t k = 0; k < kStageAxes; ++k) {
    kept = kept && std::abs(r.speed[k]) <= limits[k].speed * share &&
           std::abs(r.acceleration[k]) <= limits[k].acceleration * (share * share) &&
           std::abs(r.jerk[k]) <= limits[k].jerk * (share * share * share);
  }
  return kept;
}

/// The speed by what is allowed at the points to both sides.
double feed_share(std::span<const double> most_speed, const PlaceState& where) {
  const std::size_t i = where.place.index;
  return most_speed.empty() ? 0 : where.speed / std::min(most_speed[i], most_speed[i + 1]);
}

Need need_of(const AxesLimits& limits, const StageRates& r) {
  Need need;
  for (std::size_t k = 0; k < kStageAxes; ++k) {
    const double factor = std::max({std::abs(r.speed[k]) / limits[k].speed,
                                    std::sqrt(std::abs(r.acceleration[k]) / limits[k].acceleration),
                                    std::cbrt(std::abs(r.jerk[k]) / limits[k].jerk)});
    if (factor > need.factor) {
      need = {factor, k};
    }
  }
  return need;
}

/// What the motion of the stages takes of the speed of galvo and focus axis, acceleration and jerk.
struct Taken {
  double speed = 0;
  double acceleration = 0;
  double jerk = 0;
};

Taken taken_by(const StageRates& r, bool focus_axis, double reach_mm, double speed, double acceleration,
               const SpotState& spot, double tilt) {
  const double w = std::abs(r.speed[3]) + std::abs(r.speed[4]);
  const double w_dot = std::abs(r.acceleration[3]) + std::abs(r.acceleration[4]);
  const double w_2 = w * w + w_dot;
  const double w_3 = w * w * w + 3 * w * w_dot + std::abs(r.jerk[3]) + std::abs(r.jerk[4]);
  const double v = speed * spot.tangent.norm();
  const double a = acceleration * spot.tangent.norm();
  const double bend = std::abs(spot.bend_per_mm) * tilt;
  const auto most = [focus_axis](const StageValues& of) {
    const double across = std::max(std::abs(of[0]), std::abs(of[1]));
    return focus_axis ? std::max(across, std::abs(of[2])) : across;
  };
  return {most(r.speed) + w * reach_mm, most(r.acceleration) + w_2 * reach_mm + 2 * w * v + bend * v * v,
          most(r.jerk) + w_3 * reach_mm + 3 * w_2 * v + 3 * w * a + 3 * bend * v * a};
}

/// A limit with what is taken of it gone, though never less than a third of it.
double left(double limit, double taken) {
  constexpr double kKept = 0.999;
  return std::max(limit * kKept - taken, limit / 3);
}

}  // namespace

void cap_by_galvo(const PathTimingRequest& request, const StageSpline& stages, const SmoothPlace* place,
                  PathRuns& path) {
  const AxesLimits& limits = request.limits;
  const bool focus_axis = has_focus_axis(limits);
  for (PathRun& run : path.runs()) {
    const double speed = place != nullptr ? path.peak_speed(run) : 0;
    const double acceleration = place != nullptr ? path.peak_acceleration(run) : 0;
    Taken taken;
    double u = 0;
    double v = 0;
    double w = 0;
    const std::size_t looks = run.count;
    for (std::size_t k = 0; k <= looks; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(looks);
      const SpotState spot = path.spot(run, share * run.length_mm);
      StageRates at_rest;
      StageValues pose = stages_of(request.axes[run.first + k]);
      if (place != nullptr) {
        const PlaceState where =
            place->state(static_cast<double>(run.start) + share * static_cast<double>(run.periods), path.period_s());
        const StageState state = stages.state(where.place);
        pose = state.value;
        at_rest = rates(state, where);
      }
      const Taken here = taken_by(at_rest, focus_axis, (spot.position_mm - request.table.centre_mm).norm(), speed,
                                  acceleration, spot, std::abs(std::sin(pose[3])));
      taken = {std::max(taken.speed, here.speed), std::max(taken.acceleration, here.acceleration),
               std::max(taken.jerk, here.jerk)};
      const Vector3 direction = request.table.turned(pose[3], pose[4], spot.tangent + request.table.centre_mm);
      u = std::max(u, std::abs(direction.x()));
      v = std::max(v, std::abs(direction.y()));
      w = std::max(w, std::abs(direction.z()));
    }
    constexpr double kLeast = 1e-9;  // a run straight along the beam has to end too
    const auto cap = [&](double AxisBounds::*kind, double gone) {
      const double across = std::min(left(limits[5].*kind, gone) / std::max(u, kLeast),
                                     left(limits[6].*kind, gone) / std::max(v, kLeast));
      return focus_axis ? std::min(across, left(limits[kFocusAxis].*kind, gone) / std::max(w, kLeast)) : across;
    };
    PathRuns::cap(run, {cap(&AxisBounds::speed, taken.speed), cap(&AxisBounds::acceleration, taken.acceleration),
                        cap(&AxisBounds::jerk, taken.jerk)});
  }
}

namespace {

/// The segments that the spot passes in these periods: of long runs those alone, of others all.
std::pair<std::size_t, std::size_t> segments_between(const PathRuns& path, std::int64_t from, std::int64_t to) {
  const auto segment = [&path](std::int64_t period, bool end) {
    const PathRun& run = path.runs()[path.run_at(period)];
    if (!run.fed()) {
      return run.first + (end ? run.count - 1 : 0);
    }
    return PathRuns::place(run, RunMotion(path, run).at(std::max<std::int64_t>(period - run.start, 0))).index;
  };
  return {segment(from, false), segment(to, true)};
}

}  // namespace

Needs::Needs(const PathRuns& path) : path_(path), factors_(path.targets().size() - 1, 1.0) {}

void Needs::add(std::int64_t from_period, std::int64_t to_period, double factor) {
  const auto [first, last] = segments_between(path_, from_period, to_period);
  for (std::size_t k = first; k <= last; ++k) {
    factors_[k] = std::max(factors_[k], factor);
  }
}

void Needs::spread(const PathFeed& feed, double spread) {
  constexpr double kNothing = 1e-6;
  std::vector<double> kept(factors_.size());  // of what is more than 1, over a segment
  for (const PathRun& run : path_.runs()) {
    for (std::size_t k = run.first; k < run.first + run.count; ++k) {
      const double periods = run.fed() ? feed.segment_s(k) / path_.period_s()
                                       : static_cast<double>(run.periods) / static_cast<double>(run.count);
      kept[k] = std::exp(-periods / spread);
    }
  }
  const auto fade = [&](std::size_t from, std::size_t to) {
    const double left = (factors_[from] - 1) * kept[to];
    factors_[to] = left > kNothing ? std::max(factors_[to], 1 + left) : factors_[to];
  };
  for (std::size_t k = 1; k < factors_.size(); ++k) {
    fade(k - 1, k);
  }
  for (std::size_t k = factors_.size() - 1; k > 0; --k) {
    fade(k, k - 1);
  }
}

void Needs::slow(PathFeed& feed, PathRuns& path) const {
  for (PathRun& run : path.runs()) {
    if (run.is_long()) {
      for (std::size_t k = run.first; k < run.first + run.count; ++k) {
        feed.slow(k, factors_[k]);
      }
    } else {
      const auto first = factors_.begin() + static_cast<std::ptrdiff_t>(run.first);
      run.stretch *= *std::max_element(first, first + static_cast<std::ptrdiff_t>(run.count));
    }
  }
}

SlowDown slow_stages(const AxesLimits& limits, const StageSpline& stages, const SmoothPlace& place,
                     std::span<const double> most_speed, double gain, PathFeed& feed, PathRuns& path) {
  // Of the factor: between two looks nothing is seen, and feeds use their limits everywhere.
  const double allowed = feed.any() ? 0.995 : 0.9995;
  const double more = 1.0015 / allowed;  // so that the next pass is the last
  Needs needs(path);
  SlowDown slow;
  double worst = allowed;
  const auto cell = static_cast<double>(place.cell());
  const auto end = static_cast<double>(place.end());
  for (double period = -cell * static_cast<double>(SmoothPlace::kReach); period < end;) {
    const PlaceState where = place.state(period, path.period_s());
    const StageState state = stages.state(where.place);
    const StageRates now = rates(state, where);
    const double of_feed = feed_share(most_speed, where);
    if (of_feed > allowed || !within(limits, now, allowed)) {
      Need need = need_of(limits, now);
      need.factor = std::max(need.factor, of_feed);
      slow.needed = true;
      needs.add(static_cast<std::int64_t>(std::floor(period - cell)),
                static_cast<std::int64_t>(std::ceil(period + cell)), 1 + (need.factor * more - 1) * gain);
      if (need.factor > worst) {
        worst = need.factor;
        slow.point = where.place.index;
        slow.axis = need.axis;
      }
    }
    // An eighth of a cell, or half a point where that is less.
    const double half_point = 0.5 / std::max(where.speed * path.period_s(), 1e-12);
    period += std::clamp(half_point, cell / 64, cell / 8);
  }
  if (slow.needed) {
    needs.spread(feed, cell);
    needs.slow(feed, path);
  }
  return slow;
}

namespace {

/// When a profile from rest to rest has run so much of its stroke.
double time_at(const motion::Profile& profile, double position_mm) {
  double low = 0;
  double high = profile.access_time_s();
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (profile.at(middle).position_mm < position_mm ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

std::optional<std::size_t> cap_by_stages(const AxesLimits& limits, const StageSpline& stages, const PathRuns& path,
                                         PathRun& run) {
  constexpr int kMostTries = 60;
  constexpr std::size_t kLooks = 24;
  const double by = static_cast<double>(run.count) / std::max(run.length_mm, 1e-12);  // points a mm
  const std::size_t looks = run.count > 1 ? kLooks * run.count : 1;
  constexpr double kUnmoved = 1e-15;
  AxisBounds caps{1e12, 1e12, 1e12};
  for (std::size_t k = 0; k <= looks; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(looks);
    const StageState at = stages.state(PathRuns::place(run, share * run.length_mm));
    for (std::size_t axis = 0; axis < kStageAxes; ++axis) {
      const double slope = std::max(std::abs(at.first[axis]) * by, kUnmoved);
      caps.speed = std::min(caps.speed, limits[axis].speed / slope);
      caps.acceleration = std::min(caps.acceleration, limits[axis].acceleration / slope);
      caps.jerk = std::min(caps.jerk, limits[axis].jerk / slope);
    }
  }
  PathRuns::cap(run, caps);
  std::size_t worst = 0;
  for (int attempt = 0; attempt < kMostTries; ++attempt) {
    if (run.count == 1) {
      return std::nullopt;  // straight in the stages' own coordinates: the caps are exact
    }
    const motion::Profile profile = path.profile(run);
    double most = 1;
    std::vector<double> times_s(profile.times_s.begin(), profile.times_s.end());  // where accelerations peak
    for (std::size_t k = 1; k < run.count; ++k) {  // bends of splines peak at their points
      times_s.push_back(time_at(profile, static_cast<double>(k) / by));
    }
    for (std::size_t k = 1; k < looks; ++k) {
      times_s.push_back(profile.access_time_s() * static_cast<double>(k) / static_cast<double>(looks));
    }
    for (const double time_s : times_s) {
      const motion::State at = profile.at(time_s);
      const PlaceState where{PathRuns::place(run, at.position_mm), at.velocity_mm_s * by, at.acceleration_mm_s2 * by,
                             at.jerk_mm_s3 * by};
      const Need need = need_of(limits, rates(stages.state(where.place), where));
      if (need.factor > most) {
        most = need.factor;
        worst = need.axis;
      }
    }
    if (most <= 1) {
      return std::nullopt;
    }
    run.stretch *= most * 1.003;
  }
  return worst;
}

}  // namespace gravure::texture
