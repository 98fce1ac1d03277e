#include "gravure/texture/split.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "gravure/kinematics/machines.hpp"
#include "gravure/texture/axes.hpp"
#include "published_surface.hpp"

namespace gravure::texture {
namespace {

TexturePath published_path() {
  return {hilbert_curve(8, 40).value(), 40.0 / 255};
}

/// [A]: sigma from 30,000 um by 0.95 until the focus offset is the last limit met.
TEST(SplitByPublishedRule, EndsAtTheFifteenthSigma) {
  const auto split = split_by_published_rule(*test::published_surface(), published_path(), {},
                                             {.sigma_mm = 0, .cut = 4}, CancelToken());
  ASSERT_TRUE(split) << split.error().message;
  EXPECT_EQ(split.value().tries, 16);
  EXPECT_NEAR(split.value().sigma_mm * 1000, 13'898.737, 5e-4);
  EXPECT_NEAR(split.value().most.max_focus_mm * 1000, 98.842, 5e-4);
  EXPECT_LT(split.value().most.rms_focus_mm, split.value().most.max_focus_mm / 3);
  const auto alone =
      split_path(*test::published_surface(), published_path(), {.sigma_mm = split.value().sigma_mm, .cut = 4});
  EXPECT_EQ(alone.value().most.max_focus_mm, split.value().most.max_focus_mm);
}

/// The smallest of the stated sigmas that keeps the stages off the critical path is four times better ([A] 1.6).
TEST(SplitPath, HasTheFocusOffsetsOfTheBetterRule) {
  struct Row {
    double sigma_mm, focus_um, incidence_deg, displacement_mm;
  };
  for (const Row& row : {Row{7, 48.30, 4.621, 1.388}, Row{3.5, 22.53, 3.155, 0.944}, Row{2, 11.23, 2.230, 0.668},
                         Row{1, 5.11, 1.501, 0.450}, Row{0.5, 1.82, 0.899, 0.269}}) {
    const auto split = split_path(*test::published_surface(), published_path(), {.sigma_mm = row.sigma_mm, .cut = 4});
    ASSERT_TRUE(split);
    EXPECT_NEAR(split.value().most.max_focus_mm * 1000, row.focus_um, 0.006);
    EXPECT_NEAR(split.value().most.max_incidence_rad * 180 / std::numbers::pi, row.incidence_deg, 6e-4);
    EXPECT_NEAR(split.value().most.max_displacement_mm, row.displacement_mm, 6e-4);
  }
}

TEST(SplitByPublishedRule, SaysWhatNoSigmaMeets) {
  const DeviationLimits strict{.focus_mm = 1e-9};
  const auto split = split_by_published_rule(*test::published_surface(), published_path(), strict, {}, CancelToken());
  ASSERT_FALSE(split);
  EXPECT_EQ(split.error().code, ErrorCode::out_of_range);
  EXPECT_NE(split.error().message.find("focus offset"), std::string::npos);
  EXPECT_NE(split.error().message.find("allowed 1e-06 um"), std::string::npos);
}

TEST(SplitByPublishedRule, StopsOnRequest) {
  CancelToken cancel;
  cancel.cancel();
  const auto split = split_by_published_rule(*test::published_surface(), published_path(), {}, {}, cancel);
  ASSERT_FALSE(split);
  EXPECT_EQ(split.error().code, ErrorCode::cancelled);
}

TEST(SevenAxes, OfPointOneThousandAreThoseOfTheVector) {
  const auto split =
      split_path(*test::published_surface(), published_path(), {.sigma_mm = 30 * std::pow(0.95, 15), .cut = 4});
  const auto machine = kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, Vector3::Zero(), {});
  const auto axes = seven_axes(machine, split.value().targets, split.value().stages);
  ASSERT_TRUE(axes) << axes.error().message;
  const SevenAxes& at = axes.value()[1000];
  EXPECT_NEAR(at.x_mm, -12.7876923, 1e-7);
  EXPECT_NEAR(at.y_mm, 20.0798055, 1e-7);
  EXPECT_NEAR(at.z_mm, 6.62777253, 1e-8);
  EXPECT_NEAR(at.a_rad, 0.413144713, 1e-9);
  EXPECT_NEAR(std::remainder(at.c_rad + 0.343315018, 2 * std::numbers::pi), 0, 1e-9);
  EXPECT_NEAR(at.u_mm, -0.0107733310, 1e-9);
  EXPECT_NEAR(at.v_mm, -0.255789285, 1e-9);
  EXPECT_NEAR(at.w_mm * 1000, -0.145993, 1e-6);
}

/// [A] 1.5: C turns 173.4 times with five axes and 11.5 times with seven: unwrapped, never by more than half a turn.
TEST(SevenAxes, CountTheTurnsOfCAsPublished) {
  const auto surface = test::published_surface();
  const auto machine = kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, Vector3::Zero(), {});
  const auto travel_turns = [](const std::vector<SevenAxes>& axes) {
    double sum = 0;
    for (std::size_t i = 1; i < axes.size(); ++i) {
      const double step = std::abs(axes[i].c_rad - axes[i - 1].c_rad);
      EXPECT_LE(step, std::numbers::pi);
      sum += step;
    }
    return sum / (2 * std::numbers::pi);
  };
  const auto split = split_path(*surface, published_path(), {.sigma_mm = 30 * std::pow(0.95, 15), .cut = 4});
  const auto seven = seven_axes(machine, split.value().targets, split.value().stages);
  const auto five = seven_axes(machine, split.value().targets, split.value().targets);
  ASSERT_TRUE(seven && five);
  EXPECT_NEAR(travel_turns(five.value()), 173.4, 0.05);
  EXPECT_NEAR(travel_turns(seven.value()), 11.5, 0.05);
}

TEST(SevenAxes, KeepBothBranchesOnTheSurface) {
  const auto surface = test::published_surface();
  const auto split = split_path(*surface, {hilbert_curve(4, 40).value(), 40.0 / 15}, {.sigma_mm = 8});
  for (const auto signs : {kinematics::XyzacSigns::texturing, kinematics::XyzacSigns::post_processor}) {
    const auto machine = kinematics::xyzac_machine(signs, Vector3(3, -2, 1), {});
    for (const auto branch : {kinematics::Branch::positive, kinematics::Branch::negative}) {
      const auto axes = seven_axes(machine, split.value().targets, split.value().stages, branch);
      ASSERT_TRUE(axes) << axes.error().message;
      for (std::size_t i = 0; i < axes.value().size(); ++i) {
        const SevenAxes& at = axes.value()[i];
        const double joints[] = {at.x_mm, at.y_mm, at.z_mm, at.a_rad, at.c_rad};
        const auto spot = kinematics::forward(machine, joints, {at.u_mm, at.v_mm, at.w_mm});
        ASSERT_LT((spot.position_mm - split.value().targets[i].position_mm).norm(), 1e-9);
        ASSERT_LT((spot.towards_head - split.value().stages[i].normal).norm(), 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace gravure::texture
