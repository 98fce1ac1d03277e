// The law of corners as a feed limit, and what the stages are behind.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gravure/texture/corner_law.hpp"
#include "timing_case.hpp"

namespace gravure::texture {
namespace {

/// Two legs with a corner between, on a plane.
struct Legs : test::TimingCase {
  Legs(double turn, const char* plane)
      : TimingCase(*expression_surface(plane).value(), path_of(turn), {.sigma_mm = kSigma_mm}, Vector3::Zero(),
                   Stops::corners),
        turn_rad(turn) {}
  static TexturePath path_of(double turn_rad) {
    TexturePath path;
    path.step_mm = 0.1;
    for (int i = -kLeg; i <= kLeg; ++i) {
      const double s = path.step_mm * std::abs(i);
      path.points_mm.emplace_back(i < 0 ? Vector2(-s, 0) : Vector2(s * std::cos(turn_rad), s * std::sin(turn_rad)));
    }
    return path;
  }
  /// Of the path, from that of the stages: at the corner a Gaussian goes half way from the one direction to the other.
  double corner_speed_mm_s(const PathMotion& motion) const {
    std::vector<PathInstant> at(static_cast<std::size_t>(motion.instants()));
    EXPECT_TRUE(motion.read(0, at));
    const SevenAxes& corner = axes[kLeg];
    const auto off = [&corner](const PathInstant& now) {
      return std::hypot(now.axes[0] - corner.x_mm, now.axes[1] - corner.y_mm);
    };
    const auto there = std::min_element(at.begin() + 1, at.end() - 1,
                                        [&off](const PathInstant& a, const PathInstant& b) { return off(a) < off(b); });
    const PathInstant& before = *(there - 1);
    const PathInstant& after = *(there + 1);
    const double moved =
        std::hypot(after.axes[0] - before.axes[0], after.axes[1] - before.axes[1], after.axes[2] - before.axes[2]);
    return moved / (2 * request.servo_s) / std::cos(turn_rad / 2);
  }

  static constexpr int kLeg = 120;
  static constexpr double kSigma_mm = 1.5;
  double turn_rad;
};

TEST(CornerFeed, IsNeverExceededAndCostsNoTime) {
  for (const double degrees : {30.0, 90.0, 130.0}) {
    Legs legs(degrees * std::numbers::pi / 180, "0");
    // The bend lies across the corner: no stage has all of it, at the least its greater part.
    const double share = std::max(std::sin(legs.turn_rad / 2), std::cos(legs.turn_rad / 2));
    const double law_mm_s = corner_speed_mm_s(legs.turn_rad, Legs::kSigma_mm, 100 / share, 10'000 / share);
    const auto without = time_seven_axes(legs.request, {});
    legs.request.corner_law = true;
    const auto with = time_seven_axes(legs.request, {});
    ASSERT_TRUE(without && with);
    EXPECT_LE(legs.corner_speed_mm_s(*with.value().motion), law_mm_s) << degrees;
    EXPECT_LE(with.value().time_s, 1.002 * without.value().time_s) << degrees;
  }
}

/// Said to be of a sigma that it is not, so that the law asks for more than the limits do.
TEST(CornerFeed, BindsWhereTheLimitsDoNot) {
  Legs legs(std::numbers::pi / 2, "0.1*x");
  legs.request.sigma_points /= 40;
  const double part = std::sqrt(0.5);
  const double law_mm_s = corner_speed_mm_s(legs.turn_rad, Legs::kSigma_mm / 40, 100 / part, 10'000 / part);
  const auto without = time_seven_axes(legs.request, {});
  legs.request.corner_law = true;
  const auto with = time_seven_axes(legs.request, {});
  ASSERT_TRUE(without && with);
  EXPECT_GT(legs.corner_speed_mm_s(*without.value().motion), 1.2 * law_mm_s);
  EXPECT_LT(legs.corner_speed_mm_s(*with.value().motion), 1.05 * law_mm_s);  // of the plane; it is tilted
  EXPECT_GT(with.value().time_s, without.value().time_s);
}

TEST(CornerFeed, LeavesCornersAloneThatFollowEachOther) {
  Legs legs(std::numbers::pi / 2, "0");
  legs.request.sigma_points = Legs::kLeg / 2.5;  // no three sigma to the ends
  const auto without = time_seven_axes(legs.request, {});
  legs.request.corner_law = true;
  const auto with = time_seven_axes(legs.request, {});
  ASSERT_TRUE(without && with);
  EXPECT_EQ(with.value().time_s, without.value().time_s);
}

/// Beside the loops solved, the galvo's too fast to count.
TEST(StageLag, IsNearlyWhatTheLoopsAreBehind) {
  for (const char* plane : {"0", "0.3*x + 0.02*x*y"}) {
    Legs legs(std::numbers::pi / 3, plane);
    legs.request.servos[5] = legs.request.servos[6] = {1e5, 0.7};
    const auto timed = time_seven_axes(legs.request, {});
    ASSERT_TRUE(timed) << timed.error().message;
    const auto errors =
        predict_following(*timed.value().motion, legs.request.servos, legs.request.table, legs.request.servo_s, {});
    ASSERT_TRUE(errors);
    EXPECT_NEAR(timed.value().stage_lag_mm / errors.value().spot_mm.max, 1, 0.05) << plane;
  }
}

}  // namespace
}  // namespace gravure::texture
