#include <gtest/gtest.h>

#include <vector>

#include "gravure/motion/plan_profile.hpp"
#include "gravure/motion/synchronise.hpp"
#include "motion_test_support.hpp"

namespace gravure::motion {
namespace {

JerkRequest axis(double stroke, double v, double a, double j) {
  return {{stroke, v, a, 0.8 * a, 0, 0}, j, 0.6 * j};
}

TEST(Sampling, EndsOnTheExactTargetAtAnyUpdateRate) {
  const Profile profile = plan_profile(SFactorRequest{{0.1 + 0.2, 375, 14000, 13500, 0, 0}, 8.5, 250}).value();
  for (const double update_us : {0.7, 10.0, 62.5, 250.0, 1000.0, 1e6}) {
    const auto samples = sample_profile(profile, update_us).value();
    EXPECT_EQ(samples.back().state.position_mm, 0.1 + 0.2) << update_us;
    EXPECT_EQ(samples.back().state.velocity_mm_s, 0) << update_us;
    EXPECT_GE(samples.back().time_s, profile.access_time_s() * (1 - 1e-12));
    EXPECT_LT(samples.back().time_s, profile.access_time_s() + update_us * 1e-6);
    EXPECT_NEAR(samples.back().time_s / (update_us * 1e-6), static_cast<double>(samples.size() - 1), 1e-9);
  }
}

TEST(Sampling, EndsOnAMovingTargetAtTheAccessTime) {
  const Profile profile = plan_profile(JerkRequest{{10, 100, 1000, 1000, 0, 50}, 1e5, 1e5}).value();
  const auto samples = sample_profile(profile, 250).value();
  EXPECT_EQ(samples.back().time_s, profile.access_time_s());
  EXPECT_EQ(samples.back().state.position_mm, 10);
  EXPECT_EQ(samples.back().state.velocity_mm_s, 50);
}

TEST(Sampling, RefusesUpdatesThatAreNotPositiveOrMakeTooManySamples) {
  const Profile profile = plan_profile(axis(10, 100, 1000, 1e5)).value();
  EXPECT_FALSE(sample_profile(profile, 0));
  EXPECT_FALSE(sample_profile(profile, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(sample_profile(profile, 1, 1000).error().code, ErrorCode::out_of_range);
}

TEST(Synchronise, EndsAllAxesWithTheSlowest) {
  const std::vector<JerkRequest> axes{axis(10, 100, 1000, 1e5), axis(-200, 100, 1000, 1e5), axis(0, 1, 1, 1)};
  const SynchronisedMove move = synchronise(axes).value();
  EXPECT_EQ(move.slowest_axis, 1U);
  EXPECT_EQ(move.access_time_s, plan_profile(axes[1]).value().access_time_s());
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Profile& profile = move.axes[i];
    EXPECT_EQ(profile.access_time_s(), move.access_time_s);
    EXPECT_EQ(profile.at(move.access_time_s).position_mm, axes[i].move.stroke_mm);
    const State before = profile.at(move.access_time_s * (1 - 1e-12));
    EXPECT_NEAR(before.position_mm, axes[i].move.stroke_mm, 1e-9 * std::abs(axes[i].move.stroke_mm));
    for (int k = 0; k <= 1000; ++k) {
      const State state = profile.at(move.access_time_s * k / 1000);
      EXPECT_LE(std::abs(state.velocity_mm_s), axes[i].move.v_max_mm_s * (1 + 1e-12));
      EXPECT_LE(std::abs(state.acceleration_mm_s2), axes[i].move.a_up_mm_s2 * (1 + 1e-12));
    }
  }
}

TEST(Synchronise, KeepsTheSpeedAtMovingEnds) {
  std::vector<JerkRequest> axes{axis(200, 100, 1000, 1e5), axis(50, 100, 1000, 1e5)};
  axes[1].move.start_velocity_mm_s = 20;
  axes[1].move.end_velocity_mm_s = 5;
  const SynchronisedMove move = synchronise(axes).value();
  const Profile& second = move.axes[1];
  EXPECT_EQ(second.at(0).velocity_mm_s, 20);
  EXPECT_EQ(second.at(second.access_time_s()).velocity_mm_s, 5);
  EXPECT_NEAR(second.at(second.access_time_s() * (1 - 1e-13)).position_mm, 50, 1e-8);
  EXPECT_LT(second.peak_velocity_mm_s, 100);
}

TEST(Synchronise, RefusesNoAxisAndAnAxisThatCannotWait) {
  EXPECT_EQ(synchronise({}).error().code, ErrorCode::bad_argument);
  std::vector<JerkRequest> axes{axis(200, 100, 1000, 1e5), axis(1, 100, 1000, 1e5)};
  axes[1].move.start_velocity_mm_s = 50;
  axes[1].move.end_velocity_mm_s = 50;
  const auto refused = synchronise(axes);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_NE(refused.error().message.find("axis 1"), std::string::npos);
}

TEST(Rendezvous, MeetsTheTargetWithItsVelocityWithinTheLimits) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  for (int trial = 0; trial < 10'000; ++trial) {
    JerkRequest request = axis(random.between(-50, 50), random.log_between(10, 1000), 1000, 1e5);
    request.move.start_velocity_mm_s = random.between(-1, 1) * request.move.v_max_mm_s;
    const double target = random.between(-0.99, 0.99) * request.move.v_max_mm_s;
    const Profile profile = plan_rendezvous(request, target).value();
    const double time = profile.access_time_s();
    ASSERT_NEAR(profile.stroke_mm, request.move.stroke_mm + target * time, 1e-12 * (50 + 1000 * time));
    const State before = profile.at(time * (1 - 1e-13));
    ASSERT_NEAR(before.position_mm, profile.stroke_mm, 1e-8 * (50 + 1000 * time));
    ASSERT_NEAR(before.velocity_mm_s, target, 1e-8 * request.move.v_max_mm_s);
    ASSERT_NEAR(profile.at(0).velocity_mm_s, request.move.start_velocity_mm_s, 1e-9);
    for (int k = 0; k <= 50; ++k) {
      ASSERT_LE(std::abs(profile.at(time * k / 50).velocity_mm_s), request.move.v_max_mm_s * (1 + 1e-12));
    }
  }
}

TEST(Rendezvous, RefusesATargetAsFastAsTheLimit) {
  EXPECT_EQ(plan_rendezvous(axis(1, 10, 100, 1000), 10).error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace gravure::motion
