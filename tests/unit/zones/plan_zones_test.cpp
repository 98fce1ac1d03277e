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
