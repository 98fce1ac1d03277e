#include "gravure/texture/path_timing.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gravure/texture/planning_memory.hpp"
#include "least_time.hpp"
#include "motion_size.hpp"
#include "path_instants.hpp"
#include "seven_axis_planner.hpp"
#include "slow_stages.hpp"

namespace gravure::texture {
namespace {

/// Of several proofs of one motion, one after the other: what is done never falls, and the whole grows with each.
class ProofProgress final : public Progress {
 public:
  explicit ProofProgress(Progress* told) : told_(told) {}
  void update(std::int64_t done, std::int64_t total) override {
    whole_ = total;
    if (told_ != nullptr) {
      told_->update(before_ + done, before_ + total);
    }
  }
  void next_proof() { before_ += whole_; }

 private:
  Progress* told_;
  std::int64_t before_ = 0;
  std::int64_t whole_ = 0;
};

Result<void> check_request(const PathTimingRequest& request) {
  if (request.targets.size() < 2 || request.axes.size() != request.targets.size() ||
      request.pulse_mm.size() != request.targets.size()) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("a path of {} points with axes at {} and lengths at {}: must be 2 points or more, with both "
                    "at each",
                    request.targets.size(), request.axes.size(), request.pulse_mm.size())};
  }
  constexpr double kLeastServo_s = 0.999e-6;
  if (!(request.servo_s >= kLeastServo_s && request.servo_s <= 1)) {
    return Error{ErrorCode::out_of_range, fmt::format("servo period {} s: must be from 1e-6 to 1", request.servo_s)};
  }
  if (!(request.smoothing_s >= 0 && request.smoothing_s <= 1)) {
    return Error{ErrorCode::out_of_range, fmt::format("smoothing_s = {}: must be 0 to 1", request.smoothing_s)};
  }
  GRAVURE_CHECK(check_servos(request.servos));
  GRAVURE_CHECK(check_planning_memory(request.targets.size(), request.memory_bytes));
  GRAVURE_CHECK(check_limits(request.limits));
  return check_least_time(request);
}

}  // namespace

Result<TimedPath> time_seven_axes(const PathTimingRequest& request, const CancelToken& cancel) {
  GRAVURE_CHECK(check_request(request));
  SevenAxisPlanner planner(request);
  GRAVURE_CHECK(planner.settle(cancel));
  return planner.timed();
}

Result<ProvenPath> prove_seven_axes(const PathTimingRequest& request, const CancelToken& cancel) {
  constexpr int kMostProofs = 12;
  constexpr int kThreads = 2;  // SevenAxisMotion only looks things up
  GRAVURE_CHECK(check_request(request));
  SevenAxisPlanner planner(request);
  ProvenPath proven;
  ProofProgress progress(request.progress);
  for (;;) {
    GRAVURE_CHECK(planner.settle(cancel));
    proven.path = planner.timed();
    ++proven.proofs;
    Needs needs = planner.needs();
    bool breached = false;
    GRAVURE_TRY(proven.uses, prove_limits(
                                 *proven.path.motion, request.limits, request.servo_s, cancel,
                                 [&](const LimitUse& breach) {
                                   breached = true;
                                   planner.note(breach, needs);
                                 },
                                 kThreads, &progress));
    if (!breached || proven.proofs == kMostProofs) {
      return proven;
    }
    GRAVURE_CHECK(planner.lower(needs));
    progress.next_proof();
  }
}

Result<TimedPath> time_five_axes(const PathTimingRequest& request, const CancelToken& cancel) {
  GRAVURE_CHECK(check_request(request));
  const std::vector<std::size_t> stops = resting_points(request.targets, request.stops);
  PathRuns path({request.targets.begin(), request.targets.end()}, stops, request.servo_s);
  const StageSpline stages(request.axes, stops);
  for (PathRun& run : path.runs()) {
    if (cancel.cancelled()) {
      return Error{ErrorCode::cancelled, "stopped while the path was being timed"};
    }
    if (const auto axis = cap_by_stages(request.limits, stages, path, run)) {
      return Error{ErrorCode::out_of_range,
                   fmt::format("axis {} cannot be kept within its limits behind point {}, however slow: does it jump "
                               "there?",
                               kPathAxes[*axis], run.first)};
    }
  }
  GRAVURE_CHECK(check_duration(path.least_time_s(), request.servo_s));
  path.schedule();
  TimedPath timed;
  timed.runs = path.runs().size();
  timed.slowed = static_cast<std::size_t>(
      std::count_if(path.runs().begin(), path.runs().end(), [](const PathRun& run) { return run.stretch > 1; }));
  timed.passes = 1;
  timed.motion = std::make_shared<FiveAxisMotion>(
      std::move(path), stages, std::vector<double>(request.pulse_mm.begin(), request.pulse_mm.end()));
  timed.time_s = static_cast<double>(timed.motion->instants() - 1) * request.servo_s;
  return timed;
}

}  // namespace gravure::texture
