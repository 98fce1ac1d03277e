#include "path_runs.hpp"

#include <algorithm>
#include <cmath>

#include "gravure/motion/plan_profile.hpp"
#include "gravure/texture/stop_times.hpp"
#include "run_motion.hpp"
#include "smooth_place.hpp"

namespace gravure::texture {
namespace {

/// Slope of the surface along a direction of the plane, by its normal.
double slope(const SurfacePoint& point, const Vector2& along) {
  return -point.normal.head<2>().dot(along) / point.normal.z();
}

}  // namespace

PathRuns::PathRuns(std::vector<SurfacePoint> targets, std::span<const std::size_t> stops, double period_s)
    : targets_(std::make_shared<const std::vector<SurfacePoint>>(std::move(targets))), period_s_(period_s) {
  const std::vector<SurfacePoint>& at = *targets_;
  runs_.reserve(stops.size());
  for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
    PathRun run;
    run.first = stops[k];
    run.count = stops[k + 1] - stops[k];
    run.length_mm = (at[stops[k + 1]].position_mm - at[stops[k]].position_mm).head<2>().norm();
    runs_.push_back(run);
  }
}

namespace {

motion::Profile shortest(const PathRun& run) {
  motion::JerkRequest request;
  request.move = {run.length_mm, run.caps.speed, run.caps.acceleration, run.caps.acceleration};
  request.jerk_up_mm_s3 = run.caps.jerk;
  request.jerk_down_mm_s3 = run.caps.jerk;
  const Result<motion::Profile> planned = motion::plan_profile(request);
  return planned && planned.value().access_time_s() > 0 ? planned.value() : motion::Profile();
}

}  // namespace

void PathRuns::cap(PathRun& run, const AxisBounds& caps) {
  run.caps = caps;
  const RestToRest move = rest_to_rest(run.length_mm, caps);
  run.shortest_s = move.time_s;
  run.shortest_speed = move.speed;
  run.shortest_acceleration = move.acceleration;
}

std::int64_t PathRuns::profile_periods(const PathRun& run) const noexcept {
  constexpr double kSame = 1e-9;  // of a period: what rounding may add
  const double periods = std::ceil(run.shortest_s * run.stretch / period_s_ - kSame);
  return run.shortest_s > 0 ? std::max<std::int64_t>(1, static_cast<std::int64_t>(periods)) : 0;
}

motion::Profile PathRuns::profile(const PathRun& run) const {
  if (run.shortest_s <= 0) {
    return {};
  }
  const auto periods = static_cast<double>(profile_periods(run));
  return motion::slow_down(shortest(run), std::max(1.0, periods * period_s_ / run.shortest_s));
}

double PathRuns::peak_speed(const PathRun& run) const noexcept {
  if (!run.fed()) {
    return run.shortest_speed / std::max(1.0, static_cast<double>(run.periods) * period_s_ / run.shortest_s);
  }
  double most = 0;
  for (std::int64_t k = 0; k <= static_cast<std::int64_t>(run.feed_mm.size()); ++k) {
    most = std::max(most, run.control(k + 1) - run.control(k));
  }
  return most / (static_cast<double>(knot_) * period_s_);
}

double PathRuns::peak_acceleration(const PathRun& run) const noexcept {
  if (!run.fed()) {
    const double slower = std::max(1.0, static_cast<double>(run.periods) * period_s_ / run.shortest_s);
    return run.shortest_acceleration / (slower * slower);
  }
  double most = 0;
  for (std::int64_t k = 0; k <= static_cast<std::int64_t>(run.feed_mm.size()) + 1; ++k) {
    most = std::max(most, std::abs(run.control(k + 1) - 2 * run.control(k) + run.control(k - 1)));
  }
  const double knot_s = static_cast<double>(knot_) * period_s_;
  return most / (knot_s * knot_s);
}

void PathRuns::set_knot(std::int64_t periods) {
  knot_ = periods;
  knot_weights_.clear();
  for (std::int64_t phase = 0; phase < periods; ++phase) {
    knot_weights_.push_back(spline_weights<3>(static_cast<double>(phase) / static_cast<double>(periods)));
  }
}

double PathRuns::least_time_s() const noexcept {
  double sum = 0;
  for (const PathRun& run : runs_) {
    const auto knots = static_cast<double>(run.feed_mm.size()) * static_cast<double>(knot_);
    sum += run.fed() ? knots * period_s_ : run.shortest_s * run.stretch;
  }
  return sum;
}

void PathRuns::schedule() {
  std::int64_t start = 0;
  for (PathRun& run : runs_) {
    run.start = start;
    // A feed sets out one knot before its first control point moves on, and ends one after the last.
    run.periods = run.fed() ? (static_cast<std::int64_t>(run.feed_mm.size()) + 3) * knot_ : profile_periods(run);
    start += run.periods;
  }
}

std::size_t PathRuns::run_at(std::int64_t period) const noexcept {
  const auto after = std::upper_bound(runs_.begin(), runs_.end(), period,
                                      [](std::int64_t at, const PathRun& run) { return at < run.start; });
  return after == runs_.begin() ? 0 : static_cast<std::size_t>(after - runs_.begin()) - 1;
}

Place PathRuns::place(const PathRun& run, double run_mm) noexcept {
  const double share = run.length_mm > 0 ? std::clamp(run_mm / run.length_mm, 0.0, 1.0) : 1;
  const double in_run = share * static_cast<double>(run.count);
  const std::size_t k = std::min(static_cast<std::size_t>(in_run), run.count - 1);
  return {run.first + k, in_run - static_cast<double>(k)};
}

SpotSegment::SpotSegment(const SurfacePoint& from, const SurfacePoint& to)
    : from_(from.position_mm), step_(to.position_mm - from.position_mm) {
  // Hermite: the chord, and what leaves it with the slopes of both ends.
  const Vector2 way = step_.head<2>();
  left_ = slope(from, way) - step_.z();
  right_ = slope(to, way) - step_.z();
}

SpotState SpotSegment::state(double share) const noexcept {
  SpotState state;
  state.position_mm = position(share);
  const double length = step_.head<2>().norm();
  if (length > 0) {
    const double u = share;
    const double w = 1 - u;
    const double off_first = w * (1 - 3 * u) * left_ - u * (2 - 3 * u) * right_;
    const double off_second = (6 * u - 4) * left_ - (2 - 6 * u) * right_;
    state.tangent = Vector3(step_.x(), step_.y(), step_.z() + off_first) / length;
    state.bend_per_mm = off_second / (length * length);
  }
  return state;
}

SpotState PathRuns::spot(const PathRun& run, double run_mm) const noexcept {
  const Place at = place(run, run_mm);
  return segment(at.index).state(at.share);
}

std::vector<double> mean_places(const PathRuns& path, std::int64_t cell) {
  const std::vector<PathRun>& runs = path.runs();
  const double h = path.period_s();
  const auto last = static_cast<double>(runs.back().first + runs.back().count);
  const std::int64_t cells = (2 * path.periods() + cell) / (2 * cell) + 2;  // the last of them rests at the end
  std::vector<double> means;
  means.reserve(static_cast<std::size_t>(cells));
  std::size_t r = 0;
  // Half periods, so that odd cells have whole ends too.
  for (std::int64_t k = 0; k < cells; ++k) {
    const std::int64_t from2 = (2 * k - 1) * cell;
    const std::int64_t to2 = from2 + 2 * cell;
    const double base = static_cast<double>(runs[r].first);
    double sum = 0;  // of place - base, in half periods
    if (from2 < 0) {
      sum -= static_cast<double>(-from2) * base;
    }
    for (;;) {
      const std::int64_t start2 = 2 * runs[r].start;
      const std::int64_t end2 = start2 + 2 * runs[r].periods;
      const std::int64_t a = std::max({from2, start2, std::int64_t{0}});
      const std::int64_t b = std::min(to2, end2);
      if (b > a && runs[r].length_mm > 0) {
        const auto in_run = [&](std::int64_t half) { return static_cast<double>(half - start2) / 2; };
        // A whole profile is as long before its middle as behind it.
        const bool whole = a == start2 && b == end2 && !runs[r].fed();
        const double moved = whole ? static_cast<double>(b - a) * runs[r].length_mm / 2
                                   : RunMotion(path, runs[r]).travelled(in_run(a), in_run(b)) * 2 / h;
        sum += static_cast<double>(b - a) * (static_cast<double>(runs[r].first) - base) +
               moved * static_cast<double>(runs[r].count) / runs[r].length_mm;
      }
      if (end2 >= to2 || r + 1 == runs.size()) {
        break;
      }
      ++r;
    }
    const std::int64_t end2 = 2 * path.periods();
    if (to2 > end2) {
      sum += static_cast<double>(to2 - std::max(from2, end2)) * (last - base);
    }
    means.push_back(base + sum / static_cast<double>(2 * cell));
  }
  means.back() = last;
  return means;
}

}  // namespace gravure::texture
