#include <gtest/gtest.h>

#include <algorithm>

#include "gravure/scan/set_point_csv.hpp"
#include "roller.hpp"

namespace gravure::scan {
namespace {

using test::roller_geometry;
using test::roller_head;
using test::roller_timing;

TEST(SetPoints, AreWholeCountsOneAMicrovector) {
  const LineTrajectory trajectory = make_line_trajectory(roller_timing(), roller_geometry(), {}).value();
  ASSERT_EQ(trajectory.forward.size(), 270U);
  ASSERT_EQ(trajectory.reverse.size(), 270U);
  EXPECT_EQ(trajectory.resolution_mm, 40.0 / (1 << 20));
  for (const Direction direction : {Direction::forward, Direction::reverse}) {
    const auto& points = trajectory.set_points(direction);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto wanted = trajectory.path.at(direction, 20.0 * static_cast<double>(k));
      EXPECT_EQ(points[k].u_mm, wanted.u_mm);
      EXPECT_NEAR(points[k].u_count * trajectory.resolution_mm, wanted.u_mm, trajectory.resolution_mm / 2 * 1.000001);
      EXPECT_NEAR(points[k].v_count * trajectory.resolution_mm, wanted.v_mm, trajectory.resolution_mm / 2 * 1.000001);
    }
  }
}

TEST(SetPoints, LeadByTheLagInTicks) {
  kinematics::ScanHead head = roller_head();
  head.lag_us = ratio(25, 2);  // 25 slots
  const LineTrajectory trajectory =
      make_line_trajectory(roller_timing(), roller_geometry(roller_timing(), head), {}).value();
  EXPECT_EQ(trajectory.lag_ticks, 2050);
  EXPECT_EQ(trajectory.forward[60].u_mm, trajectory.path.at(Direction::forward, 1225).u_mm);
  const auto beyond = trajectory.path.at(Direction::reverse, 5.0);
  EXPECT_NEAR(trajectory.forward.back().u_mm, beyond.u_mm, 1e-12) << "the last one belongs to the next line already";
}

TEST(SetPoints, APulseThatTheGridOrdersOutsideTheFieldIsRefused) {
  FieldGrid grid{2, 2, -40, 40, -40, 40, {{5.9, 0}, {5.9, 0}, {5.9, 0}, {5.9, 0}}};  // the roller's lines reach 14 mm
  kinematics::ScanHead head = roller_head();
  const auto made = make_line_trajectory(roller_timing(), roller_geometry(roller_timing(), head), {true, true, grid});
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_FALSE(made.value().warnings.empty()) << "the turn is ordered beyond it";
  for (GridPoint& error : grid.errors) {
    error.u_mm = 6.1;
  }
  const auto beyond = make_line_trajectory(roller_timing(), roller_geometry(roller_timing(), head), {true, true, grid});
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, ErrorCode::out_of_range);
  EXPECT_EQ(beyond.error().message,
            "scan: field_grid has the pulse at U = -13.996, V = 0.00259185 mm ordered to U = -20.096, V = 0.00259185 "
            "mm, outside the field: field_mm = 40 reaches 20; it takes a field of 40.192 mm, or fewer pixels");
}

TEST(SetPoints, MoreThanFitIntoMemoryAreRefusedByTheirKeys) {
  LineTiming timing = roller_timing();
  timing.slots = 1'000'000;
  timing.slots_per_microvector = 1;
  const auto made = make_line_trajectory(timing, roller_geometry(timing), {});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::out_of_range);
  EXPECT_EQ(made.error().message,
            "scan: 1000000 set-points a line, one every slots_per_microvector = 1 of its 1000000 slots: at most 524288 "
            "fit; take more slots_per_microvector or fewer turn_slots");
  timing.slots_per_microvector = 20;
  timing.pixels = 600'000;
  const auto wide = make_line_trajectory(timing, roller_geometry(timing), {});
  ASSERT_FALSE(wide);
  EXPECT_EQ(wide.error().message.substr(0, 45), "scan: 600000 pixels a line of field_mm: at mo")
      << wide.error().message;
}

TEST(SetPoints, BeyondTheFieldInTheTurnAreCountsLikeOthersWithAWarning) {
  kinematics::ScanHead head = roller_head();
  const LineTrajectory inside =
      make_line_trajectory(roller_timing(), roller_geometry(roller_timing(), head), {}).value();
  EXPECT_TRUE(inside.warnings.empty());
  EXPECT_LT(inside.path.reach_mm(), 20);
  head.field_mm = 28;
  head.resolution_bits = 16;
  const LineTrajectory beyond =
      make_line_trajectory(roller_timing(), roller_geometry(roller_timing(), head), {}).value();
  EXPECT_NEAR(beyond.path.reach_mm(), inside.path.reach_mm(), 1e-9);
  ASSERT_EQ(beyond.warnings.size(), 1U);
  EXPECT_NE(beyond.warnings[0].find("scanner.field_mm = 28"), std::string::npos) << beyond.warnings[0];
  const auto least = std::min_element(beyond.forward.begin(), beyond.forward.end(),
                                      [](const SetPoint& a, const SetPoint& b) { return a.u_count < b.u_count; });
  EXPECT_LT(least->u_count, -32'768) << "not wrapped, not clamped";
  EXPECT_NEAR(least->u_count * beyond.resolution_mm, least->u_mm, beyond.resolution_mm / 2 * 1.000001);
}

TEST(SetPoints, AbsentLimitsAreWarnedOfOnce) {
  kinematics::ScanHead head = roller_head();
  const auto warnings = [&head] {
    return make_line_trajectory(roller_timing(), roller_geometry(roller_timing(), head), {}).value().warnings;
  };
  EXPECT_TRUE(warnings().empty());
  head.max_jerk_mm_s3 = std::nullopt;
  ASSERT_EQ(warnings().size(), 1U);
  EXPECT_EQ(warnings()[0], "scanner.max_jerk_mm_s3: absent, so lines and turns are not checked against it");
  head.max_speed_mm_s = head.max_acceleration_mm_s2 = std::nullopt;
  EXPECT_EQ(warnings().size(), 1U);
}

TEST(SetPoints, UndoTheDistortionOfTheField) {
  // Barrel: 1 % at the edge of the field.
  FieldGrid grid{41, 41, -20, 20, -20, 20, {}};
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const GridPoint node = grid.node(column, row);
      const double share = -0.01 * (node.u_mm * node.u_mm + node.v_mm * node.v_mm) / 400;
      grid.errors.push_back({share * node.u_mm, share * node.v_mm});
    }
  }
  const LineTrajectory plain = make_line_trajectory(roller_timing(), roller_geometry(), {}).value();
  const LineTrajectory corrected = make_line_trajectory(roller_timing(), roller_geometry(), {true, true, grid}).value();
  EXPECT_LT(corrected.forward[50].u_count, plain.forward[50].u_count) << "at the left, ordered further to the left";
  EXPECT_LT(corrected.quality.across_um, 0.08);
  // Chords between set-points of a distorted path: well below a micrometre.
  EXPECT_LT(corrected.quality.along_um, 0.2);
  EXPECT_NEAR(corrected.field_grid_error_um, grid.interpolation_error_um(), 0);
}

TEST(SetPoints, AreWrittenAsCsv) {
  const LineTrajectory trajectory = make_line_trajectory(roller_timing(), roller_geometry(), {}).value();
  const std::string csv = set_points_csv(trajectory, Direction::reverse);
  EXPECT_EQ(csv.rfind("direction,set_point,slot,tick,u_mm,v_mm,u_count,v_count\nreverse,0,0,0,", 0), 0U);
  EXPECT_NE(csv.find("\nreverse,269,5380,441160,"), std::string::npos);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 271);
}

TEST(SetPoints, JointsKeepTheirSpeedLimits) {
  LineGeometry geometry = roller_geometry();
  const double speed = 2 * test::kPi / 27'489 / (5400 * 0.5e-6);  // of the rotary axis, rad/s
  geometry.machine.joints[0].limits.max_speed = 1.001 * speed;
  EXPECT_TRUE(make_line_trajectory(roller_timing(), geometry, {}));
  geometry.machine.joints[0].limits.max_speed = 0.999 * speed;
  const auto refused = make_line_trajectory(roller_timing(), geometry, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("joint c moves at"), std::string::npos) << refused.error().message;
}

TEST(SetPoints, GeometriesThatDoNotFitTheMachineAreRefused) {
  LineGeometry geometry = roller_geometry();
  geometry.per_slot.pop_back();
  const auto refused = make_line_trajectory(roller_timing(), geometry, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace gravure::scan
