#include "run_motion.hpp"

#include <algorithm>
#include <cmath>

#include "smooth_place.hpp"

namespace gravure::texture {
namespace {

/// Integral of the position of a profile from its start to `time_s`.
double travelled_by(const motion::Profile& profile, double time_s) {
  double sum = 0;
  for (std::size_t k = 0; k < profile.durations_s.size(); ++k) {
    const double h = std::min(profile.durations_s[k], time_s - profile.times_s[k]);
    if (h <= 0) {
      continue;
    }
    sum += h * (profile.position_mm[k] + h * (profile.velocity_mm_s[k] / 2 + h * (profile.acceleration_mm_s2[k] / 6 +
                                                                                  h * profile.jerk_mm_s3[k] / 24)));
  }
  const double beyond = time_s - profile.times_s[7];
  return beyond > 0 ? sum + beyond * profile.stroke_mm : sum;
}

}  // namespace

RunMotion::RunMotion(const PathRuns& path, const PathRun& run) : path_(&path), run_(&run) {
  if (!run.fed()) {
    profile_ = path.profile(run);
  }
}

double RunMotion::at(std::int64_t period) const noexcept {
  if (period >= run_->periods) {
    return run_->length_mm;
  }
  if (!run_->fed()) {
    return profile_.at(static_cast<double>(period) * path_->period_s()).position_mm;
  }
  const std::int64_t cell = period / path_->knot();
  const std::array<double, 4>& weights = path_->knot_weights(period - cell * path_->knot());
  // From the first of the four, so that what is added to it is small and keeps its digits.
  const double base = run_->control(cell - 2);
  double sum = 0;
  for (std::int64_t i = 1; i < 4; ++i) {
    sum += weights[static_cast<std::size_t>(i)] * (run_->control(cell - 2 + i) - base);
  }
  return base + sum;
}

double RunMotion::between(double period) const noexcept {
  const double cell = std::floor(period / static_cast<double>(path_->knot()));
  const std::array<double, 4> weights = spline_weights<3>(period / static_cast<double>(path_->knot()) - cell);
  double sum = 0;
  for (std::int64_t i = 0; i < 4; ++i) {
    sum += weights[static_cast<std::size_t>(i)] * run_->control(static_cast<std::int64_t>(cell) - 2 + i);
  }
  return sum;
}

double RunMotion::travelled(double from_period, double to_period) const noexcept {
  const double h = path_->period_s();
  if (!run_->fed()) {
    return travelled_by(profile_, to_period * h) - travelled_by(profile_, from_period * h);
  }
  // Gauss with two places is exact for the cubic of each knot.
  const auto knot = static_cast<double>(path_->knot());
  const double place = 0.5 / std::sqrt(3.0);
  double sum = 0;
  for (double from = from_period; from < to_period;) {
    const double to = std::min(to_period, (std::floor(from / knot) + 1) * knot);
    const double middle = (from + to) / 2;
    sum += (to - from) / 2 * (between(middle - place * (to - from)) + between(middle + place * (to - from)));
    from = to;
  }
  return sum * h;
}

}  // namespace gravure::texture
