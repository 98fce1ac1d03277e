// Vectors computed from the published equations ([C1] eqs 1 to 7) with another program.
#include <gtest/gtest.h>

#include <cmath>

#include "gravure/motion/plan_profile.hpp"
#include "indexing_models.hpp"

namespace gravure::motion {
namespace {

using test::indexing;

struct Row {
  const char* name;
  SFactorRequest request;
  double access_ms;
};

TEST(IndexingTable, TakesThePublishedAccessTimes) {
  const Row rows[] = {
      {"I", indexing(500, 30000, 30000, 22), 62.166667},
      {"II", indexing(300, 30000, 30000, 22), 82.166667},
      {"III", indexing(375, 14000, 14000, 105), 106.369048},
      {"asymmetric", indexing(375, 14000, 13500, 82.5), 101.240079},
      {"S = 0", indexing(500, 30000, 30000, 0), 56.666667},
      {"S = 115", indexing(500, 30000, 30000, 115), 115.0},
  };
  for (const Row& row : rows) {
    const auto profile = plan_profile(row.request);
    ASSERT_TRUE(profile) << profile.error().message;
    EXPECT_NEAR(profile.value().access_time_s() * 1e3, row.access_ms, 5e-7) << row.name;
  }
}

TEST(IndexingTable, CruisesForTheTimesOfCaseThreeAndTheAsymmetricOne) {
  EXPECT_NEAR(plan_profile(indexing(375, 14000, 14000, 105)).value().durations_s[3] * 1e3, 0.297619, 5e-7);
  EXPECT_NEAR(plan_profile(indexing(375, 14000, 13500, 82.5)).value().durations_s[3] * 1e3, 5.426587, 5e-7);
}

TEST(IndexingTable, GivesTheSegmentConstantsOfTheAsymmetricProfile) {
  const Profile profile = plan_profile(indexing(375, 14000, 13500, 82.5)).value();
  const double times_ms[] = {0, 20.625, 26.785714, 47.410714, 52.837302, 73.462302, 80.615079, 101.240079};
  const double velocities[] = {0, 144.375, 230.625, 375, 375, 235.78125, 139.21875};
  const double positions[] = {0, 0.992578125, 2.147712054, 8.889508929, 10.924479167, 17.701725260, 19.042871094};
  const double accelerations[] = {0, 14000, 14000, 0, 0, -13500, -13500};
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(profile.times_s[k] * 1e3, times_ms[k], 5e-7) << k;
  }
  for (std::size_t k = 0; k < 7; ++k) {
    EXPECT_NEAR(profile.velocity_mm_s[k], velocities[k], 1e-9) << k;
    EXPECT_NEAR(profile.position_mm[k], positions[k], 5e-10) << k;
    EXPECT_NEAR(profile.acceleration_mm_s2[k], accelerations[k], 1e-9) << k;
  }
  EXPECT_FALSE(profile.reduced.velocity);
  EXPECT_FALSE(profile.reduced.acceleration());
}

TEST(IndexingTable, SaysWhichLimitGaveWayWhenTheRequestIsInfeasible) {
  const Profile profile = plan_profile(indexing(500, 30000, 30000, 115)).value();
  EXPECT_NEAR(profile.peak_velocity_mm_s, 347.826, 5e-4);
  EXPECT_NEAR(profile.peak_acceleration_up_mm_s2, 12098.3, 5e-2);
  EXPECT_NEAR(profile.peak_acceleration_down_mm_s2, 12098.3, 5e-2);
  EXPECT_TRUE(profile.reduced.velocity);
  EXPECT_TRUE(profile.reduced.acceleration_up);
  EXPECT_TRUE(profile.reduced.acceleration_down);
}

TEST(IndexingTable, LowersTheAccelerationAloneWhereOnlyTheRampIsTooShort) {
  const Profile profile = plan_profile(SFactorRequest{{100, 500, 30000, 10000, 0, 0}, 100, 250}).value();
  EXPECT_TRUE(profile.reduced.acceleration_up);  // 500 / 25 ms = 20000
  EXPECT_NEAR(profile.peak_acceleration_up_mm_s2, 20000, 1e-9);
  EXPECT_FALSE(profile.reduced.acceleration_down);
  EXPECT_FALSE(profile.reduced.velocity);
}

// The rest-to-rest times of [A]'s stages: d = 156.8627 um.
TEST(JerkLimited, TakesTheRestToRestTimesOfTheSevenAxisMachine) {
  // jerk limited: 4 (d / 2 j)^(1/3)
  const double d = 0.1568627;
  const double j = 1000;
  const Profile profile = plan_profile(JerkRequest{{d, 1e6, 1e6, 1e6, 0, 0}, j, j}).value();
  EXPECT_NEAR(profile.access_time_s(), 4 * std::cbrt(d / (2 * j)), 1e-15);
}

}  // namespace
}  // namespace gravure::motion
