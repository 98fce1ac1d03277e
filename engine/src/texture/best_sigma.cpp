#include "gravure/texture/best_sigma.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gravure/texture/planning_memory.hpp"

namespace gravure::texture {
PathTimingRequest TimedSplit::request(const PathMachine& machine, const TexturePath& path) const {
  PathTimingRequest request;
  request.targets = targets();
  request.axes = axes;
  request.pulse_mm = pulse_mm;
  request.limits = machine.limits;
  request.stops = machine.stops;
  request.servo_s = machine.servo_s;
  request.corner_law = machine.corner_law;
  request.servos = machine.servos;
  request.memory_bytes = machine.memory_bytes;
  request.sigma_points = split.sigma_mm / path.step_mm;
  const Result<RotaryTable> table = rotary_table(machine.machine);
  if (table) {
    request.table = table.value();
  }
  return request;
}

Result<TimedSplit> time_split(Split split, const TexturePath& path, const PathMachine& machine,
                              const CancelToken& cancel) {
  TimedSplit timed;
  timed.split = std::move(split);
  GRAVURE_CHECK(rotary_table(machine.machine));
  if (machine.clamping.about_x_rad != 0 || machine.clamping.about_y_rad != 0) {
    Split lying = clamped(timed.split, machine.clamping);
    GRAVURE_TRY(timed.axes, seven_axes(machine.machine, lying.targets, lying.stages, machine.branch));
    timed.lying = std::move(lying.targets);
  } else {
    GRAVURE_TRY(timed.axes, seven_axes(machine.machine, timed.split.targets, timed.split.stages, machine.branch));
  }
  timed.pulse_mm = pulse_lengths_mm(path, timed.split.targets);
  GRAVURE_TRY(timed.timed, time_seven_axes(timed.request(machine, path), cancel));
  timed.fastest_s = timed.timed.time_s;
  timed.widest_lag_mm = timed.timed.stage_lag_mm;
  timed.tries = 1;
  return timed;
}

Result<TimedSplit> split_by_time(const Splitter& splitter, const Surface& surface, const TexturePath& path,
                                 const DeviationLimits& limits, const PathMachine& machine, double share,
                                 const CancelToken& cancel, Progress* progress) {
  if (!(share >= 0) || !std::isfinite(share)) {
    return Error{ErrorCode::out_of_range, fmt::format("share of the time {}: must be 0 or more", share)};
  }
  GRAVURE_CHECK(check_planning_memory(path.points_mm.size(), machine.memory_bytes));
  GRAVURE_TRY(Split widest, split_by_published_rule(splitter, surface, path, limits, cancel));
  const int splits = widest.tries;
  GRAVURE_TRY(TimedSplit best, time_split(std::move(widest), path, machine, cancel));
  best.timed.motion.reset();
  if (splitter.keeps_limits()) {
    return best;
  }
  const double widest_lag_mm = best.widest_lag_mm;
  double fastest_s = best.timed.time_s;
  int tries = 1;
  const double published_mm = best.split.sigma_mm;
  double good_mm = published_mm;
  double bad_mm = 0;
  constexpr int kBetween = 2;
  const auto most_looks = 1 + kBetween + std::max<std::int64_t>(0, std::ilogb(published_mm / path.step_mm));
  std::int64_t looks = 0;
  const auto looked = [&] {
    if (progress != nullptr) {
      progress->update(++looks, most_looks);
    }
  };
  looked();
  const auto look = [&](double sigma_mm) -> Result<bool> {
    GRAVURE_TRY(Split split, split_path(splitter, surface, path, limits, sigma_mm, cancel));
    if (!violations(split.most, limits).empty()) {
      return false;
    }
    GRAVURE_TRY(TimedSplit timed, time_split(std::move(split), path, machine, cancel));
    timed.timed.motion.reset();
    ++tries;
    fastest_s = std::min(fastest_s, timed.timed.time_s);
    if (timed.timed.time_s > fastest_s * (1 + share)) {
      return false;
    }
    best = std::move(timed);
    return true;
  };
  while (good_mm / 2 >= path.step_mm) {
    GRAVURE_TRY(const bool good, look(good_mm / 2));
    looked();
    if (!good) {
      bad_mm = good_mm / 2;
      break;
    }
    good_mm /= 2;
  }
  for (int k = 0; k < kBetween && bad_mm > 0; ++k) {
    const double middle_mm = std::sqrt(good_mm * bad_mm);
    GRAVURE_TRY(const bool good, look(middle_mm));
    looked();
    (good ? good_mm : bad_mm) = middle_mm;
  }
  best.fastest_s = fastest_s;
  best.widest_lag_mm = widest_lag_mm;
  best.tries = tries;
  best.published_mm = published_mm;
  best.split.tries = splits;
  return best;
}

}  // namespace gravure::texture
