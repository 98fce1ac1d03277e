#include "gravure/texture/corner_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gravure/texture/decomposition.hpp"

namespace gravure::texture {
namespace {

constexpr double kStep_mm = 0.01;

std::vector<Vector2> corner(double turn_rad, int half) {
  std::vector<Vector2> path;
  for (int i = -half; i <= half; ++i) {
    const double s = kStep_mm * std::abs(i);
    path.emplace_back(i < 0 ? Vector2(-s, 0) : Vector2(s * std::cos(turn_rad), s * std::sin(turn_rad)));
  }
  return path;
}

/// Throw, acceleration and jerk of a filtered corner by differences of its points.
TEST(CornerLaw, IsWhatAFilteredCornerDemands) {
  for (const double degrees : {20.0, 90.0, 180.0}) {
    for (const double sigma_mm : {0.5, 1.5}) {
      const double turn = degrees * std::numbers::pi / 180;
      const double speed = 700;
      constexpr int kHalf = 2000;
      const std::vector<Vector2> path = corner(turn, kHalf);
      const std::vector<Vector2> slow = slow_part(path, kStep_mm, {.sigma_mm = sigma_mm}).value();
      const CornerDemand law = corner_demand(turn, speed, sigma_mm);
      EXPECT_NEAR((slow[kHalf] - path[kHalf]).norm(), law.throw_mm, 2e-3 * law.throw_mm);
      const double dt = kStep_mm / speed;
      double acceleration = 0;
      double jerk = 0;
      for (std::size_t i = kHalf - 500; i < kHalf + 500; ++i) {
        const Vector2 second = slow[i + 1] - 2 * slow[i] + slow[i - 1];
        const Vector2 third = slow[i + 2] - 3 * slow[i + 1] + 3 * slow[i] - slow[i - 1];
        acceleration = std::max(acceleration, second.norm() / (dt * dt));
        jerk = std::max(jerk, third.norm() / (dt * dt * dt));
      }
      EXPECT_NEAR(acceleration, law.acceleration_mm_s2, 1e-3 * law.acceleration_mm_s2);
      EXPECT_NEAR(jerk, law.jerk_mm_s3, 1e-3 * law.jerk_mm_s3);
    }
  }
}

/// Throw times acceleration is the same for every sigma: the feed limit meets both limits at one sigma.
TEST(CornerLaw, HasOneFeedLimitWhateverSigma) {
  for (const double turn : {0.3, 1.5707963267948966, 3.0}) {
    const double speed = corner_feed_limit_mm_s(turn, 5, 20'000).value();
    const double sigma_mm = corner_sigma_mm(turn, 5).value();
    const CornerDemand demand = corner_demand(turn, speed, sigma_mm);
    EXPECT_NEAR(demand.throw_mm, 5, 1e-12);
    EXPECT_NEAR(demand.acceleration_mm_s2, 20'000, 1e-8);
    const CornerDemand wider = corner_demand(turn, speed, 3 * sigma_mm);
    EXPECT_NEAR(wider.throw_mm * wider.acceleration_mm_s2, 5 * 20'000.0, 1e-6);
  }
  EXPECT_TRUE(std::isinf(corner_feed_limit_mm_s(0, 5, 20'000).value()));
}

/// A Gaussian leaves R (1 - exp(-w^2 sigma^2 / 2)) of a sine.
TEST(CornerLaw, LeavesOfASineWhatTheSpectrumSays) {
  const double wavelength_mm = 4;
  const double amplitude_mm = 0.8;
  std::vector<Vector2> path;
  constexpr int kHalf = 4000;
  for (int i = -kHalf; i <= kHalf; ++i) {
    path.emplace_back(0, amplitude_mm * std::cos(2 * std::numbers::pi * kStep_mm * i / wavelength_mm));
  }
  for (const double sigma_mm : {0.2, 0.7, 2.0}) {
    const std::vector<Vector2> slow = slow_part(path, kStep_mm, {.sigma_mm = sigma_mm}).value();
    EXPECT_NEAR((path[kHalf] - slow[kHalf]).norm(), sine_throw_mm(amplitude_mm, wavelength_mm, sigma_mm), 1e-9);
  }
}

TEST(CornerLaw, RefusesWhatIsNoCorner) {
  EXPECT_EQ(corner_feed_limit_mm_s(-1, 5, 1).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(corner_feed_limit_mm_s(4, 5, 1).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(corner_feed_limit_mm_s(1, 0, 1).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(corner_feed_limit_mm_s(1, 5, NAN).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(corner_sigma_mm(1, 0).error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace gravure::texture
