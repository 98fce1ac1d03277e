#include "path_feed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion_size.hpp"

namespace gravure::texture {
namespace {

constexpr double kLeastSpeed2 = 1e-6;  ///< points^2 / s^2: a path that can hardly move still ends
constexpr double kFirstSlack = 1.01;   ///< smoothing and jerk take something, too

/// What stages and galvo allow at one point: u, the acceleration in points / s^2, between lines over x, the square of
/// the speed: |slope u + bend x| <= limit of every axis.
class Allowed {
 public:
  Allowed(const AxesLimits& limits, const StageState& at, double speed2, double acceleration, double slack)
      : most_(speed2 / (slack * slack)) {
    lines_[0] = {0, acceleration / (slack * slack)};
    double by_third = std::numeric_limits<double>::infinity();  // jerk, by what speed^3 makes of it
    for (std::size_t axis = 0; axis < kStageAxes; ++axis) {
      constexpr double kUnmoved = 1e-15;
      const double slope = std::max(std::abs(at.first[axis]), kUnmoved);
      const double sign = at.first[axis] < 0 ? -1 : 1;
      lines_[axis + 1] = {sign * at.second[axis] / slope, limits[axis].acceleration / (slope * slack * slack)};
      const double fastest = limits[axis].speed / (slope * slack);
      most_ = std::min(most_, fastest * fastest);
      const double third = std::abs(at.third[axis]);
      if (third > kUnmoved) {
        by_third = std::min(by_third, limits[axis].jerk / third);
      }
    }
    const double by_jerk = std::cbrt(by_third) / slack;
    most_ = std::min(most_, by_jerk * by_jerk);
    most_ = std::max(most_, kLeastSpeed2);
  }
  /// The largest square of the speed from which `next` can be reached.
  double before(double next) const noexcept {
    double x = most_;
    constexpr int kMostSteps = 40;
    for (int step = 0; step < kMostSteps; ++step) {
      // The space between the bounds of u is concave over x: Newton's way from the right comes down to its zero.
      Line high{-0.5, next / 2};
      Line low{-0.5, 0};
      double most = high.at(x);
      double least = low.at(x);
      for (const Bound& bound : lines_) {
        const double centre = -bound.bend * x;
        if (centre + bound.reach < most) {
          most = centre + bound.reach;
          high = {-bound.bend, bound.reach};
        }
        if (centre - bound.reach > least) {
          least = centre - bound.reach;
          low = {-bound.bend, -bound.reach};
        }
      }
      if (most >= least) {
        return x;
      }
      const double closing = low.slope - high.slope;
      x = closing > 0 ? std::max((high.offset - low.offset) / closing, 0.0) : 0;
    }
    return x;
  }
  /// The largest square of the speed that can be had a point later.
  double after(double x) const noexcept {
    double most = std::numeric_limits<double>::infinity();
    for (const Bound& bound : lines_) {
      most = std::min(most, bound.reach - bound.bend * x);
    }
    return x + 2 * most;
  }

 private:
  struct Line {
    double slope = 0;
    double offset = 0;
    double at(double x) const noexcept { return offset + slope * x; }
  };
  struct Bound {
    double bend = 0;  ///< |u + bend x| <= reach
    double reach = 0;
  };
  std::array<Bound, kStageAxes + 1> lines_{};
  double most_ = 0;
};

double mm_a_point(const PathRun& run) {
  return std::max(run.length_mm, 1e-9) / static_cast<double>(run.count);
}

}  // namespace

PathFeed::PathFeed(const PathRuns& path) {
  if (std::none_of(path.runs().begin(), path.runs().end(), [](const PathRun& run) { return run.is_long(); })) {
    return;
  }
  slack_.assign(path.targets().size() - 1, kFirstSlack);
  caps_.resize(path.targets().size());
  speed2_.resize(path.targets().size());
}

void PathFeed::cap_runs(const PathRuns& path, bool ends) {
  // Of the jerk: what stopping takes, and what is left for getting faster beside it.
  constexpr double kStop = 0.8;
  constexpr double kGain = 0.1;
  const double knot_s = static_cast<double>(path.knot()) * path.period_s();
  caps_.assign(caps_.size(), {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()});
  for (const PathRun& run : path.runs()) {
    if (!run.is_long()) {
      continue;  // what it takes is its own; the stages pass it as if there were no rest
    }
    const double by = mm_a_point(run);
    const double speed = run.caps.speed / by;
    const double acceleration =
        (ends ? std::min(run.caps.acceleration, kGain * run.caps.jerk * knot_s) : run.caps.acceleration) / by;
    // Rest follows at once: the spline makes v / knot of it, and v / knot^2 of jerk.
    const double stop =
        ends ? kStop * std::min(run.caps.acceleration * knot_s, run.caps.jerk * knot_s * knot_s) / by : speed;
    for (std::size_t i = run.first; i <= run.first + run.count; ++i) {
      const bool end = i == run.first || i == run.first + run.count;
      const double most = end ? std::min(speed, stop) : speed;
      caps_[i].speed2 = std::min(caps_[i].speed2, most * most);
      caps_[i].acceleration = std::min(caps_[i].acceleration, acceleration);
    }
  }
}

void PathFeed::sweep(const AxesLimits& limits, const StageSpline& stages) {
  const std::size_t last = speed2_.size() - 1;
  const auto allowed = [&](std::size_t i) {
    const double slack = i < last ? (i > 0 ? std::max(slack_[i - 1], slack_[i]) : slack_[i]) : slack_[last - 1];
    const Place place = i < last ? Place{i, 0} : Place{last - 1, 1};
    return Allowed(limits, stages.state(place), caps_[i].speed2, caps_[i].acceleration, slack);
  };
  speed2_[last] = kLeastSpeed2;
  for (std::size_t i = last; i-- > 0;) {
    speed2_[i] = std::max(allowed(i).before(speed2_[i + 1]), kLeastSpeed2);
  }
  speed2_[0] = kLeastSpeed2;
  for (std::size_t i = 0; i < last; ++i) {
    speed2_[i + 1] = std::max(std::min(speed2_[i + 1], allowed(i).after(speed2_[i])), kLeastSpeed2);
  }
}

double PathFeed::segment_s(std::size_t segment) const noexcept {
  return 2 / (std::sqrt(speed2_[segment]) + std::sqrt(speed2_[segment + 1]));
}

/// So that the spot can stop from the speed that the stages allow at the ends of runs, on the mean.
void PathFeed::choose_knot(const AxesLimits& limits, PathRuns& path) const {
  constexpr double kLeast_s = 1e-3;
  constexpr double kMost_s = 0.05;
  double sum = 0;
  std::size_t count = 0;
  for (const PathRun& run : path.runs()) {
    if (run.is_long()) {
      sum += (std::sqrt(speed2_[run.first]) + std::sqrt(speed2_[run.first + run.count])) * mm_a_point(run);
      count += 2;
    }
  }
  const double speed = sum / static_cast<double>(count);
  const AxisBounds& u = limits[5];
  const AxisBounds& v = limits[6];
  const double stop_s =
      std::max(std::sqrt(speed / std::min(u.jerk, v.jerk)), speed / std::min(u.acceleration, v.acceleration));
  path.set_knot(std::max<std::int64_t>(2, std::llround(std::clamp(stop_s, kLeast_s, kMost_s) / path.period_s())));
}

void PathFeed::sample(PathRuns& path, PathRun& run) const {
  const double knot_s = static_cast<double>(path.knot()) * path.period_s();
  double run_s = 0;
  for (std::size_t i = run.first; i < run.first + run.count; ++i) {
    run_s += segment_s(i);
  }
  const double spans = std::max(2.0, std::ceil(run_s / knot_s));
  const double by_s = run_s / spans;
  const double by_mm = mm_a_point(run);
  run.feed_mm.resize(static_cast<std::size_t>(spans) - 1);
  std::size_t segment = run.first;
  double before_s = 0;
  double here_s = segment_s(segment);
  for (std::size_t k = 0; k < run.feed_mm.size(); ++k) {
    const double at_s = static_cast<double>(k + 1) * by_s;
    while (segment + 1 < run.first + run.count && before_s + here_s <= at_s) {
      before_s += here_s;
      here_s = segment_s(++segment);
    }
    const double in_s = std::min(at_s - before_s, here_s);
    const double from = std::sqrt(speed2_[segment]);
    const double gain = (speed2_[segment + 1] - speed2_[segment]) / 2;  // the acceleration, points / s^2
    const double share = std::min(in_s * (from + gain * in_s / 2), 1.0);
    run.feed_mm[k] = by_mm * (static_cast<double>(segment - run.first) + share);
  }
}

double PathFeed::time_s(const PathRuns& path) const noexcept {
  double sum = 0;
  for (const PathRun& run : path.runs()) {
    for (std::size_t k = run.first; run.is_long() && k < run.first + run.count; ++k) {
      sum += segment_s(k);
    }
  }
  return sum;
}

Result<void> PathFeed::plan(const AxesLimits& limits, const StageSpline& stages, PathRuns& path) {
  if (!any()) {
    return {};
  }
  if (path.knot() == 0) {
    cap_runs(path, false);
    sweep(limits, stages);
    choose_knot(limits, path);
  }
  cap_runs(path, true);
  sweep(limits, stages);
  GRAVURE_CHECK(check_places(time_s(path), path.period_s(), static_cast<double>(path.knot())));
  for (PathRun& run : path.runs()) {
    if (run.is_long()) {
      sample(path, run);
    }
  }
  return {};
}

}  // namespace gravure::texture
