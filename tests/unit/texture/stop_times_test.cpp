#include "gravure/texture/stop_times.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "dice.hpp"
#include "gravure/kinematics/machines.hpp"
#include "gravure/motion/plan_profile.hpp"
#include "gravure/texture/split.hpp"
#include "published_surface.hpp"

namespace gravure::texture {
namespace {

constexpr double kStep_mm = 40.0 / 255;

TEST(RestToRest, TakesThePublishedTimesForOneStep) {
  const AxesLimits limits = published_limits();
  EXPECT_NEAR(rest_to_rest_s(kStep_mm, limits[0]) * 1000, 89.84052, 1e-5);
  EXPECT_NEAR(rest_to_rest_s(-kStep_mm, limits[5]) * 1000, 17.12208, 1e-5);
  EXPECT_EQ(rest_to_rest_s(0, limits[0]), 0);
}

/// [A] table 1 as printed and without jerk limit, planar: 65,535 exact stops.
/// The closed form beside the planner of any ramps, in all of its five shapes and at their borders.
TEST(RestToRest, IsTheMoveOfTheProfile) {
  SCOPED_TRACE(gravure::test::Dice::note());
  gravure::test::Dice dice;
  const auto size = [&dice] { return std::pow(10.0, static_cast<double>(dice.between(-3000, 3000)) / 1000); };
  for (int trial = 0; trial < 4000; ++trial) {
    AxisBounds limits{size(), size(), size()};
    double distance = size();
    if (trial % 5 == 0) {
      limits.speed = limits.acceleration * limits.acceleration / limits.jerk;  // both are reached at once
    } else if (trial % 5 == 1) {
      distance = 2 * std::pow(limits.acceleration, 3) / (limits.jerk * limits.jerk);  // acceleration just is
    }
    motion::JerkRequest request;
    request.move = {distance, limits.speed, limits.acceleration, limits.acceleration};
    request.jerk_up_mm_s3 = request.jerk_down_mm_s3 = limits.jerk;
    const auto profile = motion::plan_profile(request);
    ASSERT_TRUE(profile) << profile.error().message;
    const RestToRest move = rest_to_rest(trial % 2 == 0 ? distance : -distance, limits);
    ASSERT_NEAR(move.time_s / profile.value().access_time_s(), 1, 1e-12) << trial;
    ASSERT_NEAR(move.speed / profile.value().peak_velocity_mm_s, 1, 1e-7) << trial;
    ASSERT_NEAR(move.acceleration / profile.value().peak_acceleration_up_mm_s2, 1, 1e-7) << trial;
  }
  EXPECT_EQ(rest_to_rest_s(0, published_limits()[0]), 0);
}

TEST(RestToRest, DecidesHowTheJerkOfTableOneIsRead) {
  const auto minutes = [](AxisBounds limits, double jerk) {
    limits.jerk = jerk;
    return 65'535 * rest_to_rest_s(kStep_mm, limits) / 60;
  };
  const AxesLimits limits = published_limits();
  EXPECT_NEAR(minutes(limits[0], 10), 868.05, 0.005);
  EXPECT_NEAR(minutes(limits[5], 1000), 187.02, 0.005);
  EXPECT_NEAR(minutes(limits[0], 10'000), 98.13, 0.005);
  EXPECT_NEAR(minutes(limits[5], 1e6), 18.70, 0.005);
  EXPECT_NEAR(minutes(limits[0], 1e14), 86.52, 0.005);
  EXPECT_NEAR(minutes(limits[5], 1e14), 6.12, 0.005);
}

struct Published {
  Published() {
    const TexturePath path{hilbert_curve(8, 40).value(), kStep_mm};
    split = split_path(*test::published_surface(), path, {.sigma_mm = 30 * std::pow(0.95, 15), .cut = 4}).value();
    const auto machine = kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, Vector3::Zero(), {});
    five = seven_axes(machine, split.targets, split.targets).value();
    seven = seven_axes(machine, split.targets, split.stages).value();
    every = resting_points(split.targets, Stops::points);
    corners = resting_points(split.targets, Stops::corners);
  }
  Split split;
  std::vector<SevenAxes> five;
  std::vector<SevenAxes> seven;
  std::vector<std::size_t> every;
  std::vector<std::size_t> corners;
};

const Published& published() {
  static const Published one;
  return one;
}

TEST(RestingPoints, OfTheHilbertCurveLeaveThePublishedRuns) {
  EXPECT_EQ(published().every.size(), 65'536U);
  int runs[4] = {};
  for (std::size_t k = 0; k + 1 < published().corners.size(); ++k) {
    const std::size_t segments = published().corners[k + 1] - published().corners[k];
    ASSERT_LE(segments, 3U);
    ++runs[segments];
  }
  EXPECT_EQ(runs[1], 40'415);
  EXPECT_EQ(runs[2], 10'922);
  EXPECT_EQ(runs[3], 1'092);
}

/// Minutes to the digits they are published with; those of A and C, whose limits are fitted to the left column, to
/// 0.02.
TEST(StopTime, IsThePublishedOne) {
  const Published& p = published();
  const AxesLimits limits = published_limits();
  const auto minutes = [&limits](const auto& axes, const auto& stops, std::size_t first, std::size_t last) {
    return stop_time_s(axes, stops, limits, first, last) / 60;
  };
  EXPECT_NEAR(minutes(p.five, p.every, 0, 2), 117.90, 0.005);
  EXPECT_NEAR(minutes(p.five, p.corners, 0, 2), 102.92, 0.005);
  EXPECT_NEAR(minutes(p.five, p.every, 0, 4), 127.65, 0.02);
  EXPECT_NEAR(minutes(p.five, p.corners, 0, 4), 111.53, 0.02);
  EXPECT_NEAR(minutes(p.five, p.every, 0, 5), 151.02, 0.02);
  EXPECT_NEAR(minutes(p.five, p.corners, 0, 5), 132.12, 0.02);
  EXPECT_NEAR(minutes(p.seven, p.every, 5, 7), 18.004, 0.0005);
  EXPECT_NEAR(minutes(p.seven, p.corners, 5, 7), 15.320, 0.0005);
  // [A]: 5.61, from a surface that is not published.
  EXPECT_NEAR(minutes(p.five, p.corners, 0, 2) / minutes(p.seven, p.every, 5, 7), 5.71, 0.01);
  EXPECT_NEAR(minutes(p.five, p.every, 0, 5) / minutes(p.seven, p.every, 5, 7), 8.38, 0.01);
}

TEST(DilatedStopTime, HasTheStagesFollow) {
  const Published& p = published();
  EXPECT_NEAR(dilated_stop_time_s(p.seven, p.every, published_limits()) / 60, 18.012, 0.01);
}

}  // namespace
}  // namespace gravure::texture
