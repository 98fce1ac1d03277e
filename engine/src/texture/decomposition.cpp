#include "gravure/texture/decomposition.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "convolve.hpp"

namespace gravure::texture {

Result<std::vector<Vector2>> slow_part(std::span<const Vector2> path_mm, double step_mm, const GaussianFilter& filter) {
  const double sigma_steps = filter.sigma_mm / step_mm;
  const double wing = filter.cut * sigma_steps + 0.5;
  constexpr double kMostWing = 1e7;
  if (!(step_mm > 0) || !(filter.sigma_mm > 0) || !(filter.cut > 0) || !(wing < kMostWing)) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("Gaussian of sigma {} mm over steps of {} mm, cut at {} sigma: all must be above 0, and at "
                    "most {} steps to each side",
                    filter.sigma_mm, step_mm, filter.cut, kMostWing)};
  }
  const auto radius = static_cast<std::int64_t>(wing);
  const auto bell = [sigma_steps](std::int64_t k) {
    const double at = static_cast<double>(k) / sigma_steps;
    return std::exp(-at * at / 2);
  };
  double sum = 0;
  for (std::int64_t k = radius; k >= 0; --k) {
    sum += (k == 0 ? 1 : 2) * bell(k);
  }
  return convolve(
      path_mm, [&](std::int64_t k) { return bell(k) / sum; }, radius, filter.ends);
}

Deviation deviation(const SurfacePoint& target, const SurfacePoint& stage) {
  const Vector3 apart = target.position_mm - stage.position_mm;
  const double focus_mm = stage.normal.dot(apart);
  return {.focus_mm = focus_mm,
          .incidence_rad = std::atan2(target.normal.cross(stage.normal).norm(), target.normal.dot(stage.normal)),
          .displacement_mm = (apart - focus_mm * stage.normal).norm()};
}

DeviationSummary summarise(std::span<const SurfacePoint> targets, std::span<const SurfacePoint> stages) {
  DeviationSummary summary;
  double squares = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Deviation each = deviation(targets[i], stages[i]);
    squares += each.focus_mm * each.focus_mm;
    summary.max_focus_mm = std::max(summary.max_focus_mm, std::abs(each.focus_mm));
    summary.max_incidence_rad = std::max(summary.max_incidence_rad, each.incidence_rad);
    summary.max_displacement_mm = std::max(summary.max_displacement_mm, each.displacement_mm);
  }
  summary.rms_focus_mm = targets.empty() ? 0 : std::sqrt(squares / static_cast<double>(targets.size()));
  return summary;
}

}  // namespace gravure::texture
