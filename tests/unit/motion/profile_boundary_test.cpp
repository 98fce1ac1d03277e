// Where branches meet: the strokes at which a limit is just reached. Other planners fail here within rounding.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "gravure/motion/plan_profile.hpp"
#include "motion_test_support.hpp"

namespace gravure::motion {
namespace {

const std::vector<long> kUlps = {-65536, -4096, -1024, -256, -64, -16, -5, -4,  -3,   -2,   -1,   0,
                                 1,      2,     3,     4,    5,   16,  64, 256, 1024, 4096, 65536};

double ramp_s(double v, double a, double j) {
  return v * j >= a * a ? v / a + a / j : 2 * std::sqrt(v / j);
}

double ramps_mm(double v, const JerkRequest& r) {
  return v / 2 * (ramp_s(v, r.move.a_up_mm_s2, r.jerk_up_mm_s3) + ramp_s(v, r.move.a_down_mm_s2, r.jerk_down_mm_s3));
}

/// Strokes at which the branch of a move from rest to rest changes: each acceleration limit and the velocity limit.
std::vector<double> boundary_strokes(const JerkRequest& r) {
  const Move& m = r.move;
  return {ramps_mm(std::min(m.v_max_mm_s, m.a_up_mm_s2 * m.a_up_mm_s2 / r.jerk_up_mm_s3), r),
          ramps_mm(std::min(m.v_max_mm_s, m.a_down_mm_s2 * m.a_down_mm_s2 / r.jerk_down_mm_s3), r),
          ramps_mm(m.v_max_mm_s, r)};
}

double end_error_mm(const Profile& p) {
  const double h = p.durations_s[6];
  return p.position_mm[6] + h * (p.velocity_mm_s[6] + h * (p.acceleration_mm_s2[6] / 2 + h * p.jerk_mm_s3[6] / 6)) -
         p.stroke_mm;
}

TEST(BranchBoundary, HoldsWithinUlpsForRoundNumberLimits) {
  const double round[] = {1, 2, 5, 10, 20, 50, 100};
  int cases = 0;
  for (const double v : round) {
    for (const double a_up : round) {
      for (const double a_down : round) {
        for (const double jerk_ratio : {0.5, 1.0, 3.0}) {
          JerkRequest request{{0, v, a_up * 10, a_down * 10, 0, 0}, a_up * 1000, a_down * 1000 * jerk_ratio};
          for (const double stroke : boundary_strokes(request)) {
            double before = 0;
            for (const long k : kUlps) {
              request.move.stroke_mm = test::nudge(stroke, k);
              const auto profile = plan_profile(request);
              ASSERT_TRUE(profile) << profile.error().message;
              const double time = profile.value().access_time_s();
              ASSERT_GE(time, before * (1 - 2e-15)) << "ulps " << k;  // a longer stroke never takes less time
              ASSERT_LE(std::abs(end_error_mm(profile.value())), 1e-14 * stroke);
              before = time;
              ++cases;
            }
          }
        }
      }
    }
  }
  EXPECT_EQ(cases, 7 * 7 * 7 * 3 * 3 * static_cast<int>(kUlps.size()));
}

TEST(BranchBoundary, MeetsFromBothSides) {
  const JerkRequest limits{{0, 100, 50, 80, 0, 0}, 700, 900};
  for (const double stroke : boundary_strokes(limits)) {
    JerkRequest below = limits;
    JerkRequest above = limits;
    below.move.stroke_mm = test::nudge(stroke, -4);
    above.move.stroke_mm = test::nudge(stroke, 4);
    const double time = plan_profile(below).value().access_time_s();
    EXPECT_NEAR(plan_profile(above).value().access_time_s(), time, 1e-14 * time);
  }
}

TEST(BranchBoundary, OfMovingEndsHoldsWithinUlps) {
  // Just the direct ramp, and just reaching v_max, with speed at both ends.
  JerkRequest request{{0, 10, 30, 40, 3, 7}, 200, 300};
  const double direct = (3.0 + 7) / 2 * ramp_s(4, 30, 200);
  const double full = (3.0 + 10) / 2 * ramp_s(7, 30, 200) + (10.0 + 7) / 2 * ramp_s(3, 40, 300);
  for (const double stroke : {direct, full}) {
    for (const long k : kUlps) {
      request.move.stroke_mm = test::nudge(stroke, k);
      const auto profile = plan_profile(request);
      ASSERT_TRUE(profile);
      EXPECT_LE(std::abs(end_error_mm(profile.value())), 1e-13) << k;
    }
  }
}

TEST(BranchBoundary, OfTheSFactorHoldsWithinUlps) {
  const double tj = 22 * 250e-6;
  for (const double boundary : {30000 * tj, 20000 * tj}) {  // v at which a ramp is just as long as tj
    for (const long k : kUlps) {
      const SFactorRequest request{{20, test::nudge(boundary, k), 30000, 20000, 0, 0}, 22, 250};
      const auto profile = plan_profile(request);
      ASSERT_TRUE(profile);
      EXPECT_LE(std::abs(end_error_mm(profile.value())), 1e-13);
    }
  }
}

TEST(Units, InMicrometresMillimetresAndMetresGiveTheSameTimes) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  for (int trial = 0; trial < 20'000; ++trial) {
    JerkRequest mm{{0, random.log_between(1, 1e4), random.log_between(10, 1e6), random.log_between(10, 1e6), 0, 0},
                   random.log_between(1e3, 1e10),
                   random.log_between(1e3, 1e10)};
    const auto boundaries = boundary_strokes(mm);
    mm.move.stroke_mm =
        trial % 4 == 3 ? random.log_between(1e-7, 1e3) : boundaries[static_cast<std::size_t>(trial % 4)];
    const double expected = plan_profile(mm).value().access_time_s();
    for (const double unit : {1e3, 1e-3}) {
      const JerkRequest other{{mm.move.stroke_mm * unit, mm.move.v_max_mm_s * unit, mm.move.a_up_mm_s2 * unit,
                               mm.move.a_down_mm_s2 * unit, 0, 0},
                              mm.jerk_up_mm_s3 * unit,
                              mm.jerk_down_mm_s3 * unit};
      ASSERT_NEAR(plan_profile(other).value().access_time_s(), expected, 1e-12 * expected);
    }
  }
}

TEST(TinyStroke, OfZeroTakesNoTime) {
  const Profile jerk = plan_profile(JerkRequest{{0, 5e3, 5e6, 5e6, 0, 0}, 5e10, 5e10}).value();
  EXPECT_EQ(jerk.access_time_s(), 0);
  EXPECT_EQ(jerk.at(0).position_mm, 0);
  const Profile s_factor = plan_profile(SFactorRequest{{0, 500, 30000, 30000, 0, 0}, 22, 250}).value();
  EXPECT_EQ(s_factor.access_time_s(), 0);
}

TEST(TinyStroke, DownToDenormalsIsReachedInATimeAboveZero) {
  for (const double stroke : {1e-4, 1e-6, 1e-7, 1e-9, 1e-12, 1e-30, 1e-100, 1e-300, 5e-324}) {
    for (const double sign : {1.0, -1.0}) {
      const auto profile = plan_profile(JerkRequest{{sign * stroke, 5e3, 5e6, 5e6, 0, 0}, 5e10, 5e10});
      ASSERT_TRUE(profile);
      EXPECT_NEAR(profile.value().access_time_s(), 4 * std::cbrt(stroke) / std::cbrt(1e11),
                  1e-12 * profile.value().access_time_s());
      EXPECT_EQ(profile.value().at(1).position_mm, sign * stroke);
    }
    const auto fixed = plan_profile(SFactorRequest{{stroke, 500, 30000, 30000, 0, 0}, 22, 250});
    EXPECT_NEAR(fixed.value().access_time_s(), 22e-3, 1e-15);
  }
}

TEST(LongStroke, OfABillionIsExact) {
  const Profile profile = plan_profile(JerkRequest{{1e9, 5e3, 5e6, 4e6, 0, 0}, 5e10, 5e9}).value();
  EXPECT_LE(std::abs(end_error_mm(profile)), 1e-14 * 1e9);
  EXPECT_EQ(profile.at(profile.access_time_s()).position_mm, 1e9);
}

TEST(JerkLimited, ReachesATargetALastBitAwayWithEqualSpeeds) {
  const double v = 0.1 + 0.2;
  for (const double stroke : {0.0, 5e-324, 1e-18, -1e-18, 1e-16, -1e-16}) {
    const auto profile = plan_profile(JerkRequest{{stroke, 1, 10, 10, v, v}, 100, 100});
    ASSERT_TRUE(profile);
    EXPECT_LE(std::abs(end_error_mm(profile.value())), 1e-15);
  }
}

TEST(Request, OutOfRangeNamesTheFieldAndItsRange) {
  const JerkRequest good{{1, 1, 1, 1, 0, 0}, 1, 1};
  JerkRequest bad = good;
  bad.move.v_max_mm_s = 0;
  ASSERT_FALSE(plan_profile(bad));
  EXPECT_EQ(plan_profile(bad).error().code, ErrorCode::out_of_range);
  EXPECT_NE(plan_profile(bad).error().message.find("v_max_mm_s = 0"), std::string::npos);
  bad = good;
  bad.move.a_down_mm_s2 = -1;
  EXPECT_FALSE(plan_profile(bad));
  bad = good;
  bad.move.stroke_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(plan_profile(bad));
  bad = good;
  bad.jerk_up_mm_s3 = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(plan_profile(bad));
  bad = good;
  bad.move.end_velocity_mm_s = 1.5;
  EXPECT_FALSE(plan_profile(bad));
  EXPECT_FALSE(plan_profile(SFactorRequest{{1, 1, 1, 1, 0, 0}, -1, 250}));
  EXPECT_FALSE(plan_profile(SFactorRequest{{1, 1, 1, 1, 0, 0}, 1, 0}));
}

}  // namespace
}  // namespace gravure::motion
