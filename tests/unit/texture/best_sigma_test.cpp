#include "gravure/texture/best_sigma.hpp"

#include <gtest/gtest.h>

#include "gravure/kinematics/machines.hpp"
#include "published_surface.hpp"

namespace gravure::texture {
namespace {

PathMachine machine_of_a() {
  return {kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, Vector3::Zero(), {}), published_limits(),
          Stops::points, 50e-6};
}

class Told final : public Progress {
 public:
  void update(std::int64_t done, std::int64_t total) override {
    EXPECT_EQ(done, ++looks);
    EXPECT_LE(done, total);
  }
  std::int64_t looks = 0;
};

/// The published case: at least four times less focus offset for less than 1 % of the time.
TEST(SplitByTime, CutsTheFocusOffsetForHardlyAnyTime) {
  const auto surface = test::published_surface();
  const TexturePath path{hilbert_curve(8, 40).value(), 40.0 / 255};
  const auto splitter = make_splitter(SplitMethod::gaussian, {.cut = 4});
  const auto wide = split_by_published_rule(*splitter, *surface, path, {}, {});
  ASSERT_TRUE(wide);
  const auto published = time_split(wide.value(), path, machine_of_a(), {});
  Told told;
  const auto best = split_by_time(*splitter, *surface, path, {}, machine_of_a(), 0.005, {}, &told);
  ASSERT_TRUE(published && best);
  EXPECT_GE(told.looks, best.value().tries);
  EXPECT_LE(best.value().timed.time_s, 1.005 * best.value().fastest_s);
  EXPECT_LT(best.value().timed.time_s, 1.01 * published.value().timed.time_s);
  EXPECT_LT(4 * best.value().split.most.max_focus_mm, published.value().split.most.max_focus_mm);
}

TEST(TimeSplit, FindsThePointsWhereTheWorkpieceLies) {
  const auto surface = test::published_surface();
  const TexturePath path{hilbert_curve(3, 2).value(), 2.0 / 7};
  const auto split = split_path(*surface, path, {.sigma_mm = 1});
  ASSERT_TRUE(split);
  PathMachine machine = machine_of_a();
  const auto level = time_split(split.value(), path, machine, {});
  machine.clamping = {0.1, -0.05};
  machine.branch = kinematics::Branch::negative;
  const auto tilted = time_split(split.value(), path, machine, {});
  ASSERT_TRUE(level && tilted);
  const Split lying = clamped(split.value(), machine.clamping);
  const auto axes = seven_axes(machine.machine, lying.targets, lying.stages, machine.branch);
  ASSERT_TRUE(axes);
  for (std::size_t i = 0; i < lying.targets.size(); ++i) {
    EXPECT_EQ(level.value().targets()[i].position_mm, split.value().targets[i].position_mm);
    EXPECT_EQ(tilted.value().targets()[i].position_mm, lying.targets[i].position_mm);
    EXPECT_EQ(tilted.value().split.targets[i].position_mm, split.value().targets[i].position_mm);
    EXPECT_EQ(tilted.value().axes[i].a_rad, axes.value()[i].a_rad);
    EXPECT_EQ(tilted.value().axes[i].c_rad, axes.value()[i].c_rad);
    EXPECT_LE(tilted.value().axes[i].a_rad, 0);
  }
  EXPECT_NE(level.value().timed.time_s, 0);
}

TEST(SplitByTime, RefusesAShareThatIsNone) {
  const auto splitter = make_splitter(SplitMethod::gaussian, {});
  const auto split = split_by_time(*splitter, *test::published_surface(), {hilbert_curve(2, 1).value(), 1.0 / 3}, {},
                                   machine_of_a(), -1, {});
  EXPECT_EQ(split.error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace gravure::texture
