#include "gravure/zones/zone_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ceramic_core.hpp"
#include "gravure/core/path_expand.hpp"

namespace gravure::zones {
namespace {

constexpr double kPeriod_s = 50e-6;

ZonePlanRequest small_core() {
  ZonePlanRequest request;
  request.contours = test::CeramicCore::contours();
  for (std::size_t i = 0; i < 6; ++i) {
    request.contours[i] = request.contours[i * 10];
    request.contours[i].id = static_cast<std::int64_t>(i);
  }
  request.contours.resize(6);
  request.max_incidence_rad = 5 * std::numbers::pi / 180;
  request.max_layer_mm = 0.15;
  request.machine = example_machine();
  // So hard a head that what lies between two set-points counts.
  request.machine.head.max_acceleration_mm_s2 = 1e7;
  request.machine.head.max_jerk_mm_s3 = 1e11;
  return request;
}

/// Distance of a point from the nearest wanted line.
double off_targets(const std::vector<PathTarget>& targets, double along_mm, const Vector3& spot) {
  const auto after = std::upper_bound(targets.begin(), targets.end(), along_mm,
                                      [](double along, const PathTarget& target) { return along < target.along_mm; });
  double least = 1e9;
  for (auto to = after - targets.begin() > 2 ? after - 2 : targets.begin() + 1; to != targets.end() && to <= after + 1;
       ++to) {
    const Vector3 a((to - 1)->position_mm.data());
    const Vector3 b(to->position_mm.data());
    const double share = b == a ? 0 : std::clamp((spot - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    if (to->along_mm > (to - 1)->along_mm) {
      least = std::min(least, (a + share * (b - a) - spot).norm());
    }
  }
  return least;
}

TEST(ZoneMotion, PutsTheSpotOnTheContoursAndStandsStillWithTheStagesWhileItMarks) {
  const ZonePlanRequest request = small_core();
  const ZonePlan plan = plan_zones(request).value();
  const auto made = ZoneMotion::create(plan, request.machine, {kPeriod_s, 200});
  ASSERT_TRUE(made) << made.error().message;
  const ZoneMotion& motion = *made.value();
  EXPECT_NEAR(motion.length_mm(), plan.length_mm, 1e-9);
  std::vector<PathInstant> instants(static_cast<std::size_t>(motion.instants()));
  ASSERT_TRUE(motion.read(0, instants));
  EXPECT_EQ(instants[0].axes, (std::array<double, kPathAxes.size()>{}));
  EXPECT_EQ(instants[0].along_mm, 0);
  EXPECT_NEAR(instants.back().along_mm, plan.length_mm, 1e-9);
  const ZoneTimes& times = motion.times();
  EXPECT_NEAR(times.stage_s + times.jump_s + times.mark_s, kPeriod_s * static_cast<double>(instants.size() - 1), 1e-6);
  for (std::size_t i = 1; i < instants.size(); ++i) {
    const PathInstant& now = instants[i];
    ASSERT_GE(now.along_mm, instants[i - 1].along_mm);
    if (now.along_mm == instants[i - 1].along_mm) {
      continue;
    }
    for (std::size_t axis = 0; axis < 5; ++axis) {
      ASSERT_EQ(now.axes[axis], instants[i - 1].axes[axis]) << i;
    }
    const Vector3 focused =
        forward(request.machine, std::span(now.axes).first(5), {now.axes[5], now.axes[6], 0}).position_mm;
    const Vector3 beam =
        forward(request.machine, std::span(now.axes).first(5), {now.axes[5], now.axes[6], 0}).towards_head;
    // In focus to within half a layer; across the beam, on the line.
    double least = 1e9;
    for (int step = -100; step <= 100; ++step) {
      least = std::min(least, off_targets(motion.targets(), now.along_mm, focused + step * 0.00075 * beam));
    }
    ASSERT_LT(least, 5e-4) << i;
  }
}

TEST(ZoneMotion, KeepsAllAxesWithinTheirLimits) {
  const ZonePlanRequest request = small_core();
  const ZonePlan plan = plan_zones(request).value();
  const auto made = ZoneMotion::create(plan, request.machine, {kPeriod_s, 200}).value();
  std::vector<PathInstant> instants(static_cast<std::size_t>(made->instants()));
  ASSERT_TRUE(made->read(0, instants));
  for (std::size_t axis = 0; axis < 7; ++axis) {
    const double speed =
        axis < 5 ? *request.machine.joints[axis].limits.max_speed : *request.machine.head.max_speed_mm_s;
    const double jerk = axis < 5 ? *request.machine.joints[axis].limits.max_jerk : *request.machine.head.max_jerk_mm_s3;
    for (std::size_t i = 3; i < instants.size(); ++i) {
      const auto at = [&](std::size_t back) { return instants[i - back].axes[axis]; };
      ASSERT_LE(std::abs(at(0) - at(1)) / kPeriod_s, speed * (1 + 1e-6)) << axis;
      ASSERT_LE(std::abs(at(0) - 3 * at(1) + 3 * at(2) - at(3)) / std::pow(kPeriod_s, 3), jerk * 1.001 + 0.5) << axis;
    }
  }
}

/// Of the cubics through the set-points, which is what the axes are ordered to follow; jumps no faster than asked for.
TEST(ZoneMotion, KeepsTheSpeedsOfItsCubicsWithinTheirLimits) {
  const ZonePlanRequest request = small_core();
  const ZonePlan plan = plan_zones(request).value();
  for (const double jump_speed_mm_s : {1e9, 700.0}) {
    const auto made = ZoneMotion::create(plan, request.machine, {kPeriod_s, 200, 1'000'000, jump_speed_mm_s}).value();
    std::vector<PathInstant> instants(static_cast<std::size_t>(made->instants()));
    ASSERT_TRUE(made->read(0, instants));
    double fastest = 0;
    for (std::size_t axis = 5; axis < 7; ++axis) {
      for (std::size_t i = 3; i < instants.size(); ++i) {
        const auto at = [&](std::size_t back) { return instants[i - back].axes[axis]; };
        for (int place = 0; place <= 10; ++place) {
          fastest = std::max(fastest, std::abs(cubic_motion({at(3), at(2), at(1), at(0)}, place / 10.0).speed));
        }
      }
    }
    const double most = std::min(jump_speed_mm_s, *request.machine.head.max_speed_mm_s);
    EXPECT_LE(fastest / kPeriod_s, most * (1 + 1e-9));
    EXPECT_GE(fastest / kPeriod_s, 0.8 * most);
  }
}

/// Speed of the spot along the path at its fastest: of the monotone cubics through what the program stores.
double fastest_spot_mm_s(const ZoneMotion& motion) {
  std::vector<PathInstant> instants(static_cast<std::size_t>(motion.instants()));
  EXPECT_TRUE(motion.read(0, instants));
  constexpr double kCountsPerMm = 1e9;
  double fastest = 0;
  for (std::size_t i = 0; i + 1 < instants.size(); ++i) {
    PathWindow window{};
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t at = std::min(i + k, instants.size()) - (i + k > 0 ? 1 : 0);
      window[k].along_counts = std::llround(instants[at].along_mm * kCountsPerMm);
    }
    fastest = std::max(fastest, CoveredPath(window).max_speed());
  }
  return fastest / kCountsPerMm / kPeriod_s;
}

TEST(ZoneMotion, KeepsTheSpotWithinTheMarkSpeedBetweenSetPoints) {
  const ZonePlanRequest request = small_core();
  const ZonePlan plan = plan_zones(request).value();
  constexpr double kRounding_mm_s = 2e-9 / kPeriod_s;  // of the path covered, to 1 pm
  for (const double speed_mm_s : {5.0, 60.0, 200.0, 900.0}) {
    const auto made = ZoneMotion::create(plan, request.machine, {kPeriod_s, speed_mm_s}).value();
    const double fastest = fastest_spot_mm_s(*made);
    EXPECT_LE(fastest, speed_mm_s + kRounding_mm_s);
    EXPECT_GE(fastest, 0.94 * std::min(speed_mm_s, 200.0));
  }
}

/// Where a stroke ends, the cubic between set-points swings beyond its end; cuts leave room for that in the field.
TEST(ZoneMotion, StaysInTheFieldBetweenSetPointsWhereContoursAreCut) {
  ZonePlanRequest request = small_core();
  request.contours.resize(1);
  request.contours[0].points_mm = {{-119.9919999, 0, 0}, {119.9919999, 0, 0}};  // four fields, less room
  request.contours[0].direction = {0, 0, 1};
  const ZonePlan plan = plan_zones(request).value();
  ASSERT_EQ(plan.pieces.size(), 4U);
  const double half_field_mm = request.machine.head.field_mm / 2;
  double farthest = 0;
  double farthest_set_point = 0;
  for (const double speed_mm_s : {300.0, 700.0, 1500.0}) {
    const auto made = ZoneMotion::create(plan, request.machine, {kPeriod_s, speed_mm_s}).value();
    std::vector<PathInstant> instants(static_cast<std::size_t>(made->instants()));
    ASSERT_TRUE(made->read(0, instants));
    for (std::size_t i = 3; i < instants.size(); ++i) {
      const auto at = [&](std::size_t back) { return instants[i - back].axes[5]; };
      farthest_set_point = std::max(farthest_set_point, std::abs(at(0)));
      for (int place = 0; place <= 10; ++place) {
        farthest = std::max(farthest, std::abs(cubic_between({at(3), at(2), at(1), at(0)}, place / 10.0)));
      }
    }
  }
  EXPECT_LE(farthest, half_field_mm);
  EXPECT_GT(farthest, farthest_set_point + 1e-5);  // without room it would be outside
  EXPECT_NEAR(farthest_set_point, half_field_mm - 0.002, 1e-6);
}

TEST(ZoneMotion, RefusesAMotionTooLongBeforeItIsReckonedOut) {
  const ZonePlanRequest request = small_core();
  const ZonePlan plan = plan_zones(request).value();
  const auto slow = ZoneMotion::create(plan, request.machine, {kPeriod_s, 1e-6});
  ASSERT_FALSE(slow);
  EXPECT_EQ(slow.error().code, ErrorCode::out_of_range);
  EXPECT_EQ(slow.error().message.rfind("mark_speed_mm_s = 1e-06: after ", 0), 0U) << slow.error().message;
  EXPECT_NE(slow.error().message.find("a program has at most 268435456 periods of servo_us, 3.73 h"),
            std::string::npos);
  ZoneMotionRequest dark{kPeriod_s, 200};
  dark.most_periods = 100;
  const auto far = ZoneMotion::create(plan, request.machine, dark);
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().message.rfind("servo_us = 50: moves in the dark take too long", 0), 0U) << far.error().message;
}

TEST(ZoneMotion, ReadsTheSameInPieces) {
  const ZonePlanRequest request = small_core();
  const ZonePlan plan = plan_zones(request).value();
  const auto made = ZoneMotion::create(plan, request.machine, {kPeriod_s, 200}).value();
  std::vector<PathInstant> all(static_cast<std::size_t>(made->instants()));
  ASSERT_TRUE(made->read(0, all));
  std::vector<PathInstant> piece(997);
  for (std::int64_t first = 0; first + 997 <= made->instants(); first += 997) {
    ASSERT_TRUE(made->read(first, piece));
    for (std::size_t i = 0; i < piece.size(); ++i) {
      ASSERT_EQ(piece[i].axes, all[static_cast<std::size_t>(first) + i].axes);
      ASSERT_EQ(piece[i].along_mm, all[static_cast<std::size_t>(first) + i].along_mm);
    }
  }
  EXPECT_EQ(made->read(made->instants(), piece).error().code, ErrorCode::bad_argument);
}

TEST(ZoneMotion, RefusesMachinesItCannotTime) {
  const ZonePlanRequest request = small_core();
  const ZonePlan plan = plan_zones(request).value();
  Machine machine = request.machine;
  machine.head.max_jerk_mm_s3.reset();
  EXPECT_EQ(ZoneMotion::create(plan, machine, {kPeriod_s, 200}).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(ZoneMotion::create(plan, request.machine, {0, 200}).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(ZoneMotion::create(plan, request.machine, {kPeriod_s, 200, 1000, 0}).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(ZoneMotion::create(plan, request.machine, {kPeriod_s, 200, 10}).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(ZoneMotion::create({}, request.machine, {kPeriod_s, 200}).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace gravure::zones
