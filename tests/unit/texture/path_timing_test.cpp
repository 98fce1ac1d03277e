#include "gravure/texture/path_timing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "gravure/core/path_expand.hpp"
#include "gravure/texture/planning_memory.hpp"
#include "published_surface.hpp"
#include "timing_case.hpp"

namespace gravure::texture {
namespace {

/// A Hilbert curve on the stated surface, its points as far apart as the published ones.
struct Fixture : test::TimingCase {
  explicit Fixture(int order, double sigma_mm, Stops stops = Stops::points)
      : TimingCase(*test::published_surface(), path_of(order), {.sigma_mm = sigma_mm, .cut = 4}, Vector3(0, -12, 0),
                   stops),
        five(seven_axes(machine, split.targets, split.targets).value()) {}
  static TexturePath path_of(int order) {
    const int side = 1 << order;
    return {hilbert_curve(order, 40.0 / 255 * (side - 1)).value(), 40.0 / 255};
  }
  std::vector<SevenAxes> five;
};

std::vector<PathInstant> all_instants(const PathMotion& motion) {
  std::vector<PathInstant> all(static_cast<std::size_t>(motion.instants()));
  EXPECT_TRUE(motion.read(0, all));
  return all;
}

std::string words(const std::vector<LimitUse>& uses) {
  std::string text;
  for (const LimitUse& use : uses) {
    text += std::string(kPathAxes[use.axis]) + " " + std::string(limit_name(use.kind)) + " " +
            std::to_string(use.share()) + "\n";
  }
  return text;
}

class ProveSevenAxes : public testing::TestWithParam<std::pair<double, Stops>> {};

TEST_P(ProveSevenAxes, LeavesNoLimitBroken) {
  const Fixture f(4, GetParam().first, GetParam().second);
  const auto proven = prove_seven_axes(f.request, {});
  ASSERT_TRUE(proven) << proven.error().message;
  EXPECT_TRUE(broken(proven.value().uses).empty()) << words(broken(proven.value().uses));
  ASSERT_EQ(proven.value().uses.size(), 21U);
}
INSTANTIATE_TEST_SUITE_P(Sigmas, ProveSevenAxes,
                         testing::Values(std::pair(6.0, Stops::points), std::pair(6.0, Stops::corners),
                                         std::pair(1.0, Stops::points), std::pair(0.3, Stops::corners)));

/// What prove_limits() says of the cubics is what ten looks a period find, and no less.
TEST(ProveLimits, FindsWhatTenTimesTheDensityFinds) {
  Fixture f(3, 3);
  f.request.limits.push_back({50, 2000, 200'000});  // W
  const auto proven = prove_seven_axes(f.request, {});
  ASSERT_TRUE(proven);
  const std::vector<PathInstant> at = all_instants(*proven.value().path.motion);
  const double h = f.request.servo_s;
  for (std::size_t axis = 0; axis < f.request.limits.size(); ++axis) {
    double most[3] = {};
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
      const std::array<double, 4> x{at[k > 0 ? k - 1 : 0].axes[axis], at[k].axes[axis], at[k + 1].axes[axis],
                                    at[std::min(k + 2, at.size() - 1)].axes[axis]};
      for (int look = 0; look <= 10; ++look) {
        const CubicMotion m = cubic_motion(x, look / 10.0);
        most[0] = std::max(most[0], std::abs(m.speed) / h);
        most[1] = std::max(most[1], std::abs(m.acceleration) / (h * h));
        most[2] = std::max(most[2], std::abs(m.jerk) / (h * h * h));
      }
    }
    for (std::size_t kind = 0; kind < 3; ++kind) {
      const LimitUse& use = proven.value().uses[axis * 3 + kind];
      EXPECT_LE(most[kind], use.most * (1 + 1e-12)) << kPathAxes[axis];
      EXPECT_GE(most[kind], use.most * 0.9999) << kPathAxes[axis];
      EXPECT_LE(most[kind], use.allowed * (1 + 1e-6)) << kPathAxes[axis];
    }
  }
}

/// Forward kinematics of every instant, by the machine itself: the light is on the path and stands on every point.
TEST(SevenAxisMotion, PutsTheLightOnThePath) {
  const Fixture f(4, 4);
  const auto timed = time_seven_axes(f.request, {});
  ASSERT_TRUE(timed) << timed.error().message;
  const std::vector<PathInstant> at = all_instants(*timed.value().motion);
  std::size_t reached = 0;
  for (const PathInstant& now : at) {
    const auto field =
        kinematics::field_of(f.machine, std::span(now.axes).first(5), f.split.targets[reached].position_mm);
    ASSERT_TRUE(field);
    const bool on_point = std::hypot(field.value().u_mm - now.axes[5], field.value().v_mm - now.axes[6]) < 1e-9;
    if (on_point && reached + 1 < f.split.targets.size()) {
      EXPECT_NEAR(now.along_mm, f.pulse_mm[reached], 1e-9);
      ++reached;
    }
  }
  EXPECT_EQ(reached + 1, f.split.targets.size());
  EXPECT_EQ(at.back().along_mm, f.pulse_mm.back());
  EXPECT_NEAR(static_cast<double>(at.size() - 1) * f.request.servo_s, timed.value().time_s, 1e-9);
}

TEST(SevenAxisMotion, RestsAtBothEndsAndNeverGoesBack) {
  const Fixture f(4, 4);
  const auto timed = time_seven_axes(f.request, {});
  ASSERT_TRUE(timed);
  const std::vector<PathInstant> at = all_instants(*timed.value().motion);
  for (std::size_t axis = 0; axis < 5; ++axis) {
    EXPECT_NEAR(at.front().axes[axis], at[1].axes[axis], 1e-9);
    EXPECT_NEAR(at.back().axes[axis], at[at.size() - 2].axes[axis], 1e-9);
  }
  EXPECT_EQ(at.front().along_mm, 0);
  for (std::size_t k = 1; k < at.size(); ++k) {
    ASSERT_GE(at[k].along_mm, at[k - 1].along_mm);
  }
}

TEST(SevenAxisMotion, ReadsTheSameFromAnyInstant) {
  const Fixture f(3, 3);
  const auto timed = time_seven_axes(f.request, {});
  ASSERT_TRUE(timed);
  const PathMotion& motion = *timed.value().motion;
  const std::vector<PathInstant> at = all_instants(motion);
  for (std::int64_t first = 0; first < motion.instants(); first += 777) {
    PathInstant one;
    ASSERT_TRUE(motion.read(first, std::span(&one, 1)));
    EXPECT_EQ(one.axes, at[static_cast<std::size_t>(first)].axes);
    EXPECT_EQ(one.along_mm, at[static_cast<std::size_t>(first)].along_mm);
  }
  PathInstant beyond;
  EXPECT_FALSE(motion.read(motion.instants(), std::span(&beyond, 1)));
}

/// Never faster than the stop model that knows no stages, and hardly slower where they are no bottle-neck.
TEST(TimeSevenAxes, StaysNearTheStopModel) {
  for (const Stops stops : {Stops::points, Stops::corners}) {
    const Fixture f(5, 8, stops);
    const auto timed = time_seven_axes(f.request, {});
    ASSERT_TRUE(timed);
    const std::vector<std::size_t> rests = resting_points(f.split.targets, stops);
    const double model_s = stop_time_s(f.axes, rests, f.request.limits, 5, 7);
    const double lead_s = 0.4;
    EXPECT_GT(timed.value().time_s, model_s);
    EXPECT_LT(timed.value().time_s, 1.02 * model_s + lead_s);
  }
}

/// C goes by many turns there, and its jerk is known to their rounding.
void expect_limits_kept(const PathMotion& motion, const PathTimingRequest& request) {
  const auto uses = prove_limits(motion, request.limits, request.servo_s, {});
  ASSERT_TRUE(uses);
  for (const LimitUse& use : uses.value()) {
    EXPECT_LE(use.share(), 1.0002) << kPathAxes[use.axis] << " " << limit_name(use.kind);
  }
}

TEST(TimeFiveAxes, IsTheStopModelAndKeepsLimits) {
  Fixture f(5, 4);
  f.request.axes = f.five;
  const auto timed = time_five_axes(f.request, {});
  ASSERT_TRUE(timed) << timed.error().message;
  const double model_s = stop_time_s(f.five, resting_points(f.split.targets, Stops::points), f.request.limits, 0, 5);
  EXPECT_NEAR(timed.value().time_s, model_s, 0.001 * model_s);
  expect_limits_kept(*timed.value().motion, f.request);
  f.request.stops = Stops::corners;
  const auto corners = time_five_axes(f.request, {});
  ASSERT_TRUE(corners);
  EXPECT_LT(corners.value().time_s, timed.value().time_s);
  expect_limits_kept(*corners.value().motion, f.request);
}

/// [U V W] reaches from the stages to the spot: with W the light is on the surface, without it it is off by as much.
TEST(FocusAxis, TakesUpWhatTheStagesLeaveAlongTheBeam) {
  Fixture f(4, 6);
  const auto without = prove_seven_axes(f.request, {});
  ASSERT_TRUE(without) << without.error().message;
  f.request.limits.push_back({50, 2000, 200'000});
  const auto with = prove_seven_axes(f.request, {});
  ASSERT_TRUE(with) << with.error().message;
  EXPECT_TRUE(broken(with.value().uses).empty()) << words(broken(with.value().uses));
  ASSERT_EQ(with.value().uses.size(), 24U);
  const auto off_mm = [&f](const PathInstant& at, const Vector3& point) {
    const std::span<const double> joints(at.axes.data(), 5);
    const kinematics::FieldPoint field{at.axes[5], at.axes[6], at.axes[kFocusAxis]};
    return (kinematics::forward(f.machine, joints, field).position_mm - point).norm();
  };
  double most_without = 0;
  for (const ProvenPath* path : {&without.value(), &with.value()}) {
    std::size_t point = 0;
    for (const PathInstant& at : all_instants(*path->path.motion)) {
      if (point < f.pulse_mm.size() && at.along_mm == f.pulse_mm[point]) {  // it rests on every point
        const double off = off_mm(at, f.split.targets[point++].position_mm);
        if (path == &with.value()) {
          EXPECT_LT(off, 1e-9) << point;
        } else {
          EXPECT_EQ(at.axes[kFocusAxis], 0);
          most_without = std::max(most_without, off);
        }
      }
    }
    EXPECT_EQ(point, f.pulse_mm.size());
  }
  EXPECT_GT(most_without, 0.01);
}

/// A slow W makes the whole motion slower, and is kept within its limits.
TEST(FocusAxis, SlowsTheMotionWhereItIsWhatIsSlow) {
  Fixture f(4, 6);
  f.request.limits.push_back({50, 2000, 200'000});
  const auto fast = prove_seven_axes(f.request, {});
  ASSERT_TRUE(fast);
  f.request.limits.back() = {50, 2, 200};
  const auto slow = prove_seven_axes(f.request, {});
  ASSERT_TRUE(slow) << slow.error().message;
  EXPECT_GT(slow.value().path.time_s, 1.2 * fast.value().path.time_s);
  EXPECT_TRUE(broken(slow.value().uses).empty()) << words(broken(slow.value().uses));
  EXPECT_GT(slow.value().uses[kFocusAxis * 3 + 1].share(), 0.3);
  f.request.limits.back().acceleration = 0;
  EXPECT_NE(time_seven_axes(f.request, {}).error().message.find("axis W"), std::string::npos);
  f.request.limits.resize(6);
  EXPECT_EQ(time_seven_axes(f.request, {}).error().code, ErrorCode::bad_argument);
}

/// More than one thread finds what one finds.
TEST(ProveLimits, SaysTheSameWhateverTheThreads) {
  const Fixture f(4, 2);
  const auto timed = time_seven_axes(f.request, {});
  ASSERT_TRUE(timed);
  AxesLimits tight = f.request.limits;
  tight[5].jerk /= 2;
  std::array<std::vector<LimitUse>, 3> uses;
  std::array<std::int64_t, 3> breaches{};
  const std::array<int, 3> threads{1, 2, 5};
  for (std::size_t k = 0; k < threads.size(); ++k) {
    const auto proven = prove_limits(
        *timed.value().motion, tight, f.request.servo_s, {}, [&](const LimitUse&) { ++breaches[k]; }, threads[k]);
    ASSERT_TRUE(proven);
    uses[k] = proven.value();
    EXPECT_GT(breaches[k], 0);
    EXPECT_EQ(breaches[k], breaches[0]);
    for (std::size_t i = 0; i < uses[k].size(); ++i) {
      EXPECT_EQ(uses[k][i].most, uses[0][i].most);
      EXPECT_EQ(uses[k][i].instant, uses[0][i].instant);
    }
  }
}

TEST(TimeSevenAxes, RefusesWhatWouldNeverEndBeforeReckoning) {
  Fixture f(3, 3);
  f.request.limits.push_back({50, 2000, 200'000});  // W
  EXPECT_TRUE(time_seven_axes(f.request, {}));
  for (std::size_t axis = 0; axis < f.request.limits.size(); ++axis) {
    for (double AxisBounds::*bound : {&AxisBounds::speed, &AxisBounds::acceleration, &AxisBounds::jerk}) {
      PathTimingRequest slow = f.request;
      slow.limits[axis].*bound = 1e-40;
      const auto refused = time_seven_axes(slow, {});
      ASSERT_FALSE(refused) << kPathAxes[axis];
      EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
      EXPECT_EQ(refused.error().message.rfind("axis " + std::string(kPathAxes[axis]) + ": ", 0), 0U)
          << refused.error().message;
    }
  }
}

/// Before anything as long as the motion is asked for: a limit of 1e-9 would take an hour a point.
TEST(TimeSevenAxes, RefusesMotionThatNothingHolds) {
  for (const Stops stops : {Stops::points, Stops::corners}) {
    Fixture f(3, 3, stops);
    for (const std::size_t axis : {0U, 4U, 6U}) {
      for (const AxisBounds& bounds : {AxisBounds{1e-9, 1, 1}, AxisBounds{1, 1e-18, 1}, AxisBounds{1, 1, 1e-30}}) {
        PathTimingRequest slow = f.request;
        slow.limits[axis] = bounds;
        const auto timed = time_seven_axes(slow, {});
        EXPECT_TRUE(!timed || timed.value().time_s < 1e7) << axis;
        slow.limits[axis].jerk = 1e-30;
        const auto refused = time_seven_axes(slow, {});
        ASSERT_FALSE(refused) << axis;
        EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
        slow.axes = f.five;
        EXPECT_TRUE(axis > 4 || !time_five_axes(slow, {})) << axis;
      }
    }
  }
}

TEST(TimeSevenAxes, KeepsToTheMemoryItIsGiven) {
  Fixture f(2, 3);
  EXPECT_GE(planning_bytes(1'000'000), 1'000'000'000);
  f.request.memory_bytes = planning_bytes(f.request.targets.size());
  EXPECT_TRUE(time_seven_axes(f.request, {}));
  --f.request.memory_bytes;
  const auto refused = time_seven_axes(f.request, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_NE(refused.error().message.find("a path of 16 points needs"), std::string::npos) << refused.error().message;
  EXPECT_NE(refused.error().message.find("does for 15 points"), std::string::npos) << refused.error().message;
}

TEST(TimeSevenAxes, RefusesWhatIsNoRequest) {
  Fixture f(2, 3);
  PathTimingRequest wrong = f.request;
  wrong.servo_s = 0;
  EXPECT_EQ(time_seven_axes(wrong, {}).error().code, ErrorCode::out_of_range);
  wrong = f.request;
  wrong.limits[6].jerk = -1;
  EXPECT_NE(time_seven_axes(wrong, {}).error().message.find("axis V"), std::string::npos);
  wrong = f.request;
  wrong.axes = wrong.axes.first(3);
  EXPECT_EQ(time_five_axes(wrong, {}).error().code, ErrorCode::out_of_range);
  CancelToken cancel;
  cancel.cancel();
  EXPECT_EQ(time_seven_axes(f.request, cancel).error().code, ErrorCode::cancelled);
  kinematics::Machine tilted = f.machine;
  tilted.head.lens = kinematics::Lens::f_theta;
  EXPECT_EQ(rotary_table(tilted).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace gravure::texture
