#include "gravure/texture/corner_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace gravure::texture {
namespace {

const double kRootTwoPi = std::sqrt(2 * std::numbers::pi);

/// Length of the difference of the directions before and after the corner.
double bend(double turn_rad) {
  return 2 * std::sin(turn_rad / 2);
}

Result<void> check(double turn_rad, double most_throw_mm, double most_acceleration_mm_s2) {
  if (!(turn_rad >= 0 && turn_rad <= std::numbers::pi) || !(most_throw_mm > 0) || !(most_acceleration_mm_s2 > 0)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("corner of {} rad with a galvo of {} mm and stages of {} mm/s^2: the turn must be from 0 "
                             "to pi, the others above 0",
                             turn_rad, most_throw_mm, most_acceleration_mm_s2)};
  }
  return {};
}

}  // namespace

CornerDemand corner_demand(double turn_rad, double speed_mm_s, double sigma_mm) {
  const double u = bend(turn_rad);
  const double peak = u / (sigma_mm * kRootTwoPi);  // of the second derivative by arc length
  return {.throw_mm = u * sigma_mm / kRootTwoPi,
          .acceleration_mm_s2 = peak * speed_mm_s * speed_mm_s,
          .jerk_mm_s3 = peak * std::exp(-0.5) / sigma_mm * speed_mm_s * speed_mm_s * speed_mm_s};
}

Result<double> corner_feed_limit_mm_s(double turn_rad, double most_throw_mm, double most_acceleration_mm_s2) {
  GRAVURE_CHECK(check(turn_rad, most_throw_mm, most_acceleration_mm_s2));
  return std::sqrt(2 * std::numbers::pi * most_throw_mm * most_acceleration_mm_s2) / bend(turn_rad);
}

double corner_speed_mm_s(double turn_rad, double sigma_mm, double most_acceleration_mm_s2, double most_jerk_mm_s3) {
  const CornerDemand unit = corner_demand(turn_rad, 1, sigma_mm);
  return std::min(std::sqrt(most_acceleration_mm_s2 / unit.acceleration_mm_s2),
                  std::cbrt(most_jerk_mm_s3 / unit.jerk_mm_s3));
}

Result<double> corner_sigma_mm(double turn_rad, double most_throw_mm) {
  GRAVURE_CHECK(check(turn_rad, most_throw_mm, 1));
  return most_throw_mm * kRootTwoPi / bend(turn_rad);
}

double sine_throw_mm(double amplitude_mm, double wavelength_mm, double sigma_mm) {
  const double phase = 2 * std::numbers::pi * sigma_mm / wavelength_mm;
  return amplitude_mm * -std::expm1(-phase * phase / 2);
}

}  // namespace gravure::texture
