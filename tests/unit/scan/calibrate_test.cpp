#include <gtest/gtest.h>

#include <cmath>

#include "dice.hpp"
#include "gravure/scan/calibrate.hpp"

namespace gravure::scan {
namespace {

GridPoint landing(const GridPoint& p) {
  const double share = 1 + 0.0006 * (p.u_mm * p.u_mm + p.v_mm * p.v_mm) / 15;
  return {share * p.u_mm + 0.03, share * p.v_mm - 0.002 * p.u_mm};
}

/// Marks on a regular plate, an outer frame of the field left free.
std::vector<MeasuredPoint> plate(int marks_a_side, double reach_mm) {
  std::vector<MeasuredPoint> points;
  for (int row = 0; row < marks_a_side; ++row) {
    for (int column = 0; column < marks_a_side; ++column) {
      const GridPoint order{reach_mm * (2.0 * column / (marks_a_side - 1) - 1),
                            reach_mm * (2.0 * row / (marks_a_side - 1) - 1)};
      points.push_back({order, landing(order)});
    }
  }
  return points;
}

TEST(Calibrate, MakesAGridThatLandsWithinItsInterpolationError) {
  const auto result = calibrate_field(plate(17, 15), {30, 17, 17, 1e-6});
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_LT(result.value().max_um, 0.05) << "every mark is a node";
  const FieldGrid& grid = result.value().grid;
  for (double u = -14; u <= 14; u += 0.71) {
    for (double v = -14; v <= 14; v += 0.73) {
      const GridPoint wanted = landing({u, v});
      const auto order = grid.command_for(wanted);
      ASSERT_TRUE(order) << order.error().message;
      EXPECT_LT(std::hypot(order.value().u_mm - u, order.value().v_mm - v) * 1000,
                1.2 * grid.interpolation_error_um() + 0.05);
    }
  }
}

TEST(Calibrate, FillsWhereNothingWasMeasuredStraightOn) {
  // A scanner that is only scaled and turned: straight continuation is exact.
  std::vector<MeasuredPoint> points = plate(7, 9);
  for (MeasuredPoint& point : points) {
    point.landing = {1.01 * point.order.u_mm - 0.003 * point.order.v_mm + 0.2,
                     0.003 * point.order.u_mm + 0.99 * point.order.v_mm};
  }
  const auto result = calibrate_field(points, {30, 9, 9, 1e-4});
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_LT(result.value().max_um, 1e-6);
  const GridPoint corner = result.value().grid.lands_at({15, -15}).value();
  EXPECT_NEAR(corner.u_mm, 15 * 1.01 + 0.003 * 15 + 0.2, 1e-8);
  EXPECT_NEAR(corner.v_mm, 0.003 * 15 - 15 * 0.99, 1e-8);
}

TEST(Calibrate, ReportsTheMarkThatFitsWorst) {
  std::vector<MeasuredPoint> points = plate(25, 15);
  points[321].landing.u_mm += 0.05;
  const auto result = calibrate_field(points, {30, 9, 9, 1e-4});
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result.value().worst, 321U);
  EXPECT_GT(result.value().max_um, 25);
  EXPECT_LT(result.value().rms_um, 4);
}

/// A mark near a node pulls that node along; its neighbours are then as far off as itself.
TEST(Calibrate, NamesTheMisreadMarkWhereTheGridFollowsIt) {
  SCOPED_TRACE(gravure::test::Dice::note());
  gravure::test::Dice dice;
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<MeasuredPoint> points = plate(21, 20);
    const auto wrong = static_cast<std::size_t>(dice.between(0, 440));
    points[wrong].landing.v_mm += trial % 2 == 0 ? 0.3 : 1.0;
    const auto result = calibrate_field(points, {40, 17, 17, 1e-4});
    if (result) {
      EXPECT_EQ(result.value().worst, wrong);
      EXPECT_GT(result.value().worst_alone_um, 250);
    } else {
      EXPECT_NE(result.error().message.find("mark " + std::to_string(wrong) + " at"), std::string::npos)
          << result.error().message;
    }
  }
}

/// By its definition: fitted again without the mark.
TEST(Calibrate, SaysHowFarTheWorstMarkIsFromAGridWithoutIt) {
  std::vector<MeasuredPoint> points = plate(9, 14);
  points[31].landing.u_mm += 0.08;
  const CalibrationRequest request{30, 9, 9, 1e-3};
  const auto whole = calibrate_field(points, request);
  ASSERT_TRUE(whole);
  ASSERT_EQ(whole.value().worst, 31U);
  const MeasuredPoint left_out = points[31];
  points.erase(points.begin() + 31);
  const auto others = calibrate_field(points, request);
  ASSERT_TRUE(others);
  const GridPoint there = others.value().grid.lands_at(left_out.order).value();
  EXPECT_NEAR(whole.value().worst_alone_um,
              1000 * std::hypot(there.u_mm - left_out.landing.u_mm, there.v_mm - left_out.landing.v_mm), 1e-6);
}

TEST(Calibrate, RefusesWhatGivesNoGrid) {
  const auto points = plate(5, 15);
  EXPECT_FALSE(calibrate_field(points, {0, 9, 9, 1e-4}));
  EXPECT_FALSE(calibrate_field(points, {30, 1, 9, 1e-4}));
  EXPECT_FALSE(calibrate_field(points, {30, 9, 34, 1e-4}));
  EXPECT_FALSE(calibrate_field(points, {30, 9, 9, 0}));
  EXPECT_FALSE(calibrate_field(points, {30, 9, 9, 1e-13}));
  const auto outside = calibrate_field(points, {29, 9, 9, 1e-4});
  ASSERT_FALSE(outside);
  EXPECT_NE(outside.error().message.find("mark 0"), std::string::npos) << outside.error().message;
  EXPECT_FALSE(calibrate_field({points.begin(), points.begin() + 2}, {30, 9, 9, 1e-4}));
  const auto line = calibrate_field({points.begin(), points.begin() + 5}, {30, 9, 9, 1e-4});
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().code, ErrorCode::bad_argument);
  EXPECT_NE(line.error().message.find("line"), std::string::npos);
}

TEST(Calibrate, ReadsMeasuredPointsFromCsv) {
  const auto points = parse_measured_points(
      "u_order_mm, v_order_mm,u_landing_mm,v_landing_mm\n# plate 3\n-15,15,-15.01,15.02\n0;0;0.1;0\n");
  ASSERT_TRUE(points) << points.error().message;
  ASSERT_EQ(points.value().size(), 2U);
  EXPECT_EQ(points.value()[0].landing.v_mm, 15.02);
  const auto refused = parse_measured_points("0,0,0,0\n1,2,3\n");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("line 2"), std::string::npos);
}

TEST(Calibrate, TakesNoHeadingWithOtherColumnsOrUnits) {
  for (const char* heading : {"v_order_mm,u_order_mm,u_landing_mm,v_landing_mm",
                              "u_order_um,v_order_um,u_landing_um,v_landing_um", "l0,-10,-10,10"}) {
    const auto points = parse_measured_points(std::string(heading) + "\n0,0,0,0\n");
    ASSERT_FALSE(points) << heading;
    EXPECT_NE(points.error().message.find("line 1"), std::string::npos);
    EXPECT_NE(points.error().message.find("the heading u_order_mm"), std::string::npos);
  }
}

}  // namespace
}  // namespace gravure::scan
