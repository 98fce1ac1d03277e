#include "gravure/texture/clamping.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "gravure/kinematics/machines.hpp"
#include "gravure/texture/axes.hpp"
#include "published_surface.hpp"

namespace gravure::texture {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(CTravel, IsWhatTheAxesDo) {
  const auto split = split_path(*test::published_surface(), {hilbert_curve(6, 40).value(), 40.0 / 63}, {.sigma_mm = 5});
  const Clamping clamping{0.1, -0.2};
  const Split lying = clamped(split.value(), clamping);
  const auto machine = kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, Vector3::Zero(), {});
  const auto axes = seven_axes(machine, lying.targets, lying.stages).value();
  double turns = 0;
  double rate = 0;
  double pole = 10;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    pole = std::min(pole, axes[i].a_rad);
    if (i > 0) {
      const double step = std::abs(axes[i].c_rad - axes[i - 1].c_rad);
      turns += step / (2 * std::numbers::pi);
      rate = std::max(rate, step / (40.0 / 63));
    }
  }
  const CTravel travel = c_travel(split.value().stages, 40.0 / 63, clamping);
  EXPECT_NEAR(travel.turns, turns, 1e-9);
  EXPECT_NEAR(travel.max_rate_rad_per_mm, rate, 1e-9);
  EXPECT_NEAR(travel.nearest_pole_rad, pole, 1e-9);
}

TEST(Clamped, KeepsDeviationsAndLengths) {
  const Split split =
      split_path(*test::published_surface(), {hilbert_curve(4, 40).value(), 40.0 / 15}, {.sigma_mm = 8}).value();
  const Split lying = clamped(split, {0.3, 0.4});
  const DeviationSummary most = summarise(lying.targets, lying.stages);
  EXPECT_NEAR(most.max_focus_mm, split.most.max_focus_mm, 1e-12);
  EXPECT_NEAR(most.max_incidence_rad, split.most.max_incidence_rad, 1e-12);
  EXPECT_NEAR(most.max_displacement_mm, split.most.max_displacement_mm, 1e-12);
  EXPECT_NEAR(lying.targets[9].position_mm.norm(), split.targets[9].position_mm.norm(), 1e-12);
}

/// A dish is walked round its pole: lying flat C turns once a round, leaning it swings a little.
TEST(AdviseClamping, LeansADishOffItsPole) {
  const auto dish = expression_surface("(x^2+y^2)/600").value();
  std::vector<Vector2> round;
  for (int i = 0; i < 3000; ++i) {
    round.emplace_back(6 * std::cos(0.01 * i), 6 * std::sin(0.01 * i));
  }
  const auto advice = advise_clamping(test::on(*dish, round), 0.06, 20 * kDegree, CancelToken());
  ASSERT_TRUE(advice);
  EXPECT_TRUE(advice.value().pays);
  EXPECT_NEAR(advice.value().flat.turns, 2999 * 0.01 / (2 * std::numbers::pi), 1e-6);
  EXPECT_LT(advice.value().tilted.turns, 0.3 * advice.value().flat.turns);
  EXPECT_LT(advice.value().tilted.max_rate_rad_per_mm, 0.2 * advice.value().flat.max_rate_rad_per_mm);
  EXPECT_GT(advice.value().tilted.nearest_pole_rad, advice.value().flat.nearest_pole_rad);
}

TEST(AdviseClamping, LeavesARampAsItLies) {
  const auto ramp = expression_surface("x").value();
  std::vector<Vector2> line;
  for (int i = 0; i < 100; ++i) {
    line.emplace_back(0.1 * i, 0);
  }
  const auto advice = advise_clamping(test::on(*ramp, line), 0.1, 20 * kDegree, CancelToken());
  ASSERT_TRUE(advice);
  EXPECT_FALSE(advice.value().pays);
  EXPECT_EQ(advice.value().clamping.about_x_rad, 0);
  EXPECT_EQ(advice.value().clamping.about_y_rad, 0);
}

TEST(AdviseClamping, StopsOnRequest) {
  CancelToken cancel;
  cancel.cancel();
  EXPECT_EQ(advise_clamping({}, 1, 0.1, cancel).error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace gravure::texture
