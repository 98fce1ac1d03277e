#include "seven_axis_planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "corner_feed.hpp"
#include "motion_size.hpp"
#include "slow_stages.hpp"
#include "stage_lag.hpp"

namespace gravure::texture {
namespace {

constexpr int kMostPasses = 300;
constexpr double kSpread = 0.7637626158259734;  ///< of SmoothPlace, in cells: (7 / 12)^(1/2)

double smoothing_s(const PathTimingRequest& request, const PathRuns& path, bool fed) {
  if (request.smoothing_s > 0) {
    return request.smoothing_s;
  }
  constexpr double kMost_s = 0.06;
  double least_s = 0.005;
  // Feeds change from full acceleration to full braking at once: that takes twice a / j at least.
  for (std::size_t axis = 0; fed && axis < kStageAxes; ++axis) {
    least_s = std::max(least_s, 2 * request.limits[axis].acceleration / request.limits[axis].jerk);
  }
  const double point_s =
      static_cast<double>(path.periods()) * path.period_s() / static_cast<double>(request.targets.size() - 1);
  return std::clamp(request.sigma_points * point_s / 4, least_s, std::max(least_s, kMost_s));
}

/// Places that slow each other come to rest only slowly: after some passes each asks for more than it needs.
double gain_of(int pass) {
  constexpr int kPlain = 4;
  constexpr double kMore = 0.25;
  return 1 + kMore * std::max(0, pass - kPlain);
}

/// Whether a fed run takes longer than the galvo alone would.
bool slowed_feed(const PathRuns& path, const PathRun& run) {
  return run.fed() && static_cast<double>(run.periods - 2 * path.knot()) * path.period_s() > run.shortest_s;
}

}  // namespace

SevenAxisPlanner::SevenAxisPlanner(const PathTimingRequest& request)
    : request_(request),
      path_({request.targets.begin(), request.targets.end()}, resting_points(request.targets, request.stops),
            request.servo_s) {
  const std::size_t ends[] = {0, request.targets.size() - 1};
  stages_ = StageSpline(request.axes, ends);
  feed_ = PathFeed(path_);
  if (request.corner_law) {
    corner_feed_ = corner_feed(request);
  }
}

Result<void> SevenAxisPlanner::start() {
  cap_by_galvo(request_, stages_, nullptr, path_);
  GRAVURE_CHECK(check_duration(path_.least_time_s(), request_.servo_s));
  GRAVURE_CHECK(feed_.plan(request_.limits, stages_, path_));
  GRAVURE_CHECK(check_duration(path_.least_time_s(), request_.servo_s));
  path_.schedule();
  const double cell = smoothing_s(request_, path_, feed_.any()) / kSpread / request_.servo_s;
  GRAVURE_CHECK(check_places(path_.least_time_s(), request_.servo_s, std::max(cell, 2.0)));
  cell_ = std::max<std::int64_t>(2, std::llround(cell));
  place_ = SmoothPlace(mean_places(path_, cell_), cell_, request_.targets.size());
  return {};
}

Result<void> SevenAxisPlanner::retime() {
  GRAVURE_CHECK(feed_.plan(request_.limits, stages_, path_));
  GRAVURE_CHECK(check_duration(path_.least_time_s(), request_.servo_s));
  GRAVURE_CHECK(check_places(path_.least_time_s(), request_.servo_s, static_cast<double>(cell_)));
  path_.schedule();
  place_ = SmoothPlace(mean_places(path_, cell_), cell_, request_.targets.size());
  return {};
}

Result<void> SevenAxisPlanner::settle(const CancelToken& cancel) {
  if (passes_ == 0) {
    GRAVURE_CHECK(start());
  }
  // What the stages take of the galvo is looked at once more when they have been slowed: it only gets less.
  for (int pass = 0;; ++pass) {
    if (cancel.cancelled()) {
      return Error{ErrorCode::cancelled, "stopped while the path was being timed"};
    }
    ++passes_;
    const SlowDown slow = slow_stages(request_.limits, stages_, place_, corner_feed_, gain_of(pass), feed_, path_);
    if (slow.needed && pass == kMostPasses) {
      return Error{
          ErrorCode::out_of_range,
          fmt::format("axis {} cannot be kept within its limits near point {}, however slow: does it jump there?",
                      kPathAxes[slow.axis], slow.point)};
    }
    if (slow.needed) {
      GRAVURE_CHECK(retime());
    } else if (pass > 0) {
      return {};
    }
    if (pass == 0) {
      cap_by_galvo(request_, stages_, &place_, path_);
      GRAVURE_CHECK(retime());
    }
  }
}

void SevenAxisPlanner::note(const LimitUse& breach, Needs& needs) const {
  constexpr double kMore = 1.002;
  const double power = breach.kind == LimitKind::speed ? 1 : breach.kind == LimitKind::acceleration ? 2 : 3;
  const std::int64_t period = breach.instant - SmoothPlace::kReach * cell_;
  const std::int64_t reach = breach.axis < kStageAxes ? cell_ + cell_ / 2 : 1 + 2 * path_.knot();
  needs.add(period - reach, period + reach, kMore * std::pow(breach.share(), 1 / power));
}

Result<void> SevenAxisPlanner::lower(const Needs& needs) {
  needs.slow(feed_, path_);
  return retime();
}

TimedPath SevenAxisPlanner::timed() const {
  TimedPath timed;
  timed.runs = path_.runs().size();
  timed.slowed =
      static_cast<std::size_t>(std::count_if(path_.runs().begin(), path_.runs().end(), [this](const PathRun& run) {
        return run.stretch > 1 || slowed_feed(path_, run);
      }));
  timed.passes = passes_;
  timed.stage_lag_mm = stage_lag_mm(request_, stages_, place_);
  timed.smoothing_s = static_cast<double>(cell_) * kSpread * request_.servo_s;
  timed.motion = std::make_shared<SevenAxisMotion>(
      path_, stages_, place_, std::vector<double>(request_.pulse_mm.begin(), request_.pulse_mm.end()), request_.table,
      has_focus_axis(request_.limits));
  timed.time_s = static_cast<double>(timed.motion->instants() - 1) * request_.servo_s;
  return timed;
}

}  // namespace gravure::texture
