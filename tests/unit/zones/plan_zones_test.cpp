#include "gravure/zones/plan_zones.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ceramic_core.hpp"

namespace gravure::zones {
namespace {

ZonePlanRequest core_request() {
  ZonePlanRequest request;
  request.contours = test::CeramicCore::contours();
  request.max_incidence_rad = 5 * std::numbers::pi / 180;
  request.max_layer_mm = 0.3;
  request.machine = example_machine();
  return request;
}

TEST(PlanZones, MarksEveryMillimetreOnceInFieldAndFocus) {
  const ZonePlanRequest request = core_request();
  const ZonePlan plan = plan_zones(request).value();
  EXPECT_TRUE(plan.violations.empty());
  EXPECT_EQ(plan.zones.size(), 6U);
  EXPECT_EQ(plan.lower_bound, 6U);
  EXPECT_TRUE(plan.is_tour_proved);
  EXPECT_LE(plan.tour_time_s, plan.naive_time_s);
  double length = 0;
  for (const PlannedZone& zone : plan.zones) {
    double last_z = 1e9;
    for (const PlannedLayer& layer : zone.layers) {
      EXPECT_LT(layer.z_mm, last_z);  // top first
      last_z = layer.z_mm;
      EXPECT_LE(zone.layer_thickness_mm, 0.3 * (1 + 1e-12));
      for (const Stroke& stroke : layer.strokes) {
        length += length_mm(stroke.points_mm);
        for (const Vector3& point : stroke.points_mm) {
          const auto at = field_of(request.machine, layer.joints, zone.frame.to_part(point)).value();
          EXPECT_LE(std::max(std::abs(at.u_mm), std::abs(at.v_mm)), 30 + 1e-9);
          EXPECT_LE(std::abs(at.w_mm), zone.layer_thickness_mm / 2 + 1e-9);
        }
      }
    }
  }
  EXPECT_NEAR(length, plan.length_mm, 1e-9);
}

TEST(PlanZones, CutsLongContoursAndKeepsTheirLength) {
  ZonePlanRequest request = core_request();
  request.contours.resize(1);
  auto& points = request.contours[0].points_mm;
  points = {{0, 0, 0}, {100, 0, 0}, {100, 0, 30}};
  const ZonePlan plan = plan_zones(request).value();
  EXPECT_TRUE(plan.violations.empty());
  EXPECT_GE(plan.pieces.size(), 2U);
  EXPECT_NEAR(plan.length_mm, 130, 1e-9);
}

TEST(PlanZones, SaysWhichLimitsAGivenNumberOfClustersBreaks) {
  ZonePlanRequest request = core_request();
  request.method = Method::kmeans;
  request.kmeans.clusters = 3;
  const ZonePlan plan = plan_zones(request).value();
  EXPECT_EQ(plan.zones.size(), 3U);
  EXPECT_FALSE(plan.violations.empty());
  EXPECT_EQ(plan.lower_bound, 6U);
}

/// Lines of 1 mm, each seen from where A stands at its angle.
ZonePlanRequest tilted_request(const std::vector<double>& tilts_deg) {
  ZonePlanRequest request = core_request();
  request.contours.clear();
  for (const double tilt_deg : tilts_deg) {
    const double tilt = tilt_deg * std::numbers::pi / 180;
    Contour contour;
    contour.id = static_cast<std::int64_t>(request.contours.size() + 7);
    contour.direction = {0, std::sin(tilt), std::cos(tilt)};
    const double y = 10 * std::sin(tilt);
    const double z = 10 * std::cos(tilt);
    contour.points_mm = {{0, y, z}, {1, y, z}};
    request.contours.push_back(contour);
  }
  return request;
}

TEST(PlanZones, TurnsAZoneWithinTravelWhereItsContoursAllowIt) {
  for (const std::vector<double>& tilts :
       {std::vector<double>{120, 122}, {123}, {121, 124.9999}, {119, 120, 123, 124}}) {
    const ZonePlanRequest request = tilted_request(tilts);
    const Result<ZonePlan> plan = plan_zones(request);
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_TRUE(plan.value().violations.empty());
    ASSERT_EQ(plan.value().zones.size(), 1U);
    const PlannedZone& zone = plan.value().zones[0];
    EXPECT_LE(zone.zone.max_incidence_rad, request.max_incidence_rad + 1e-9);
    for (const PlannedLayer& layer : zone.layers) {
      const double a_deg = std::abs(layer.joints[3]) * 180 / std::numbers::pi;
      EXPECT_LE(a_deg, 120);
      EXPECT_GT(a_deg, 119.99);  // the nearest
    }
  }
}

TEST(PlanZones, LeavesZonesWithinTravelAsTheyAre) {
  const ZonePlan plan = plan_zones(tilted_request({117, 119})).value();
  ASSERT_EQ(plan.zones.size(), 1U);
  EXPECT_NEAR(plan.zones[0].zone.max_incidence_rad, std::numbers::pi / 180, 1e-9);
}

TEST(PlanZones, TurnsAwayFromThePoleWhereTravelBeginsBeyondIt) {
  ZonePlanRequest request = tilted_request({30, 32});
  request.machine.joints[3].limits.least = 33 * std::numbers::pi / 180;
  const Result<ZonePlan> plan = plan_zones(request);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_NEAR(plan.value().zones[0].layers[0].joints[3] * 180 / std::numbers::pi, 33, 0.01);
}

TEST(PlanZones, NamesTheContourThatNoTravelReaches) {
  const Result<ZonePlan> plan = plan_zones(tilted_request({120, 126}));
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::out_of_range);
  EXPECT_EQ(plan.error().message,
            "contour 8: layer 0: kinematics: joint A at 126 deg: its limits are -120 to 120: no direction found within "
            "5 deg of its own is within travel: allow more incidence, clamp the part another way and move its contours "
            "with it, or take a machine of more travel");
}

/// Nine degrees from each other, all 123 deg from where A is 0: a direction within 5 deg of both is beyond 120 deg.
TEST(PlanZones, HalvesAZoneWhoseContoursAreWithinTravelOnlyApart) {
  ZonePlanRequest request = tilted_request({123, 123, 123, 123});
  const double half = std::asin(std::sin(4.5 * std::numbers::pi / 180) / std::sin(123 * std::numbers::pi / 180));
  for (std::size_t i = 0; i < request.contours.size(); ++i) {
    Contour& contour = request.contours[i];
    const double turn = i % 2 == 0 ? half : -half;
    contour.direction = {contour.direction[1] * std::sin(turn), contour.direction[1] * std::cos(turn),
                         contour.direction[2]};
    contour.points_mm[0][0] += static_cast<double>(i);
    contour.points_mm[1][0] += static_cast<double>(i);
  }
  const Result<ZonePlan> plan = plan_zones(request);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_TRUE(plan.value().violations.empty());
  EXPECT_EQ(plan.value().lower_bound, 1U);
  EXPECT_EQ(plan.value().added_for_travel, 1U);
  ASSERT_EQ(plan.value().zones.size(), 2U);
  for (const PlannedZone& zone : plan.value().zones) {
    EXPECT_EQ(zone.zone.pieces.size(), 2U);
    EXPECT_LE(zone.zone.max_incidence_rad, request.max_incidence_rad + 1e-9);
    EXPECT_LE(std::abs(zone.layers[0].joints[3]) * 180 / std::numbers::pi, 120);
  }
}

/// Told once too often, it asks to stop.
class Stopping final : public Progress {
 public:
  explicit Stopping(int calls) : calls_left_(calls) {}
  void update(std::int64_t done, std::int64_t total) override {
    EXPECT_LE(last_, done);
    EXPECT_LE(done, total);
    last_ = done;
    if (calls_left_-- == 0) {
      token.cancel();
    }
  }
  CancelToken token;

 private:
  int calls_left_;
  std::int64_t last_ = 0;
};

TEST(PlanZones, StopsWhereverItIsAskedTo) {
  for (const Method method : {Method::cover, Method::kmeans}) {
    ZonePlanRequest request = core_request();
    request.method = method;
    const ZonePlan undisturbed = plan_zones(request).value();
    int calls = 0;
    for (bool stopped = true; stopped; ++calls) {
      Stopping stopping(calls);
      request.watch = {&stopping.token, &stopping};
      const Result<ZonePlan> plan = plan_zones(request);
      stopped = stopping.token.cancelled();
      ASSERT_EQ(static_cast<bool>(plan), !stopped) << calls;
      if (stopped) {
        EXPECT_EQ(plan.error().code, ErrorCode::cancelled);
      } else {
        EXPECT_EQ(plan.value().tour_time_s, undisturbed.tour_time_s);
      }
    }
    EXPECT_GT(calls, 20);
  }
}

TEST(PlanZones, RefusesWhatItCannotDo) {
  ZonePlanRequest request = core_request();
  request.max_layer_mm = 0;
  EXPECT_EQ(plan_zones(request).error().code, ErrorCode::out_of_range);
  request = core_request();
  request.machine.head.field_mm = 0;
  EXPECT_FALSE(plan_zones(request));
  request = core_request();
  request.contours.clear();
  EXPECT_EQ(plan_zones(request).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace gravure::zones
