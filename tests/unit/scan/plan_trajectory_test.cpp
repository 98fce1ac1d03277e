#include "gravure/scan/plan_trajectory.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "plans.hpp"

namespace gravure::scan {
namespace {

using test::scanner_job;
using test::scanner_plan;

TEST(PlanTrajectory, TakesHeadAndOptionsFromThePlan) {
  Job job = scanner_job(Mode::rotary);
  job.scanner.resolution_bits = 18;
  job.scanner.lag_us = ratio(25, 2);
  job.scanner.tilt_deg_per_mm = ratio(35, 100);
  job.scanner.compensate_lag = false;
  job.scanner.cross_scan_correction = false;
  const Plan plan = scanner_plan(job);
  const kinematics::ScanHead head = scan_head(*plan.scanner);
  EXPECT_EQ(head.field_mm, 40);
  EXPECT_EQ(head.resolution_bits, 18);
  EXPECT_EQ(head.lag_us, ratio(25, 2));
  EXPECT_EQ(head.lens, kinematics::Lens::f_theta);
  EXPECT_DOUBLE_EQ(head.tilt_rad_per_mm, 0.35 * std::numbers::pi / 180);
  EXPECT_EQ(head.max_speed_mm_s, 40'000);
  EXPECT_EQ(head.max_acceleration_mm_s2, 4e7);
  EXPECT_EQ(head.max_jerk_mm_s3, 4e12);
  const auto made = plan_trajectory(plan);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made.value().lag_ticks, 0);
  EXPECT_FALSE(made.value().options.cross_scan_correction);
  EXPECT_EQ(made.value().resolution_mm, 40.0 / (1 << 18));
}

TEST(PlanTrajectory, ZigzagsWithoutCrossScanCorrectionAndNotWithIt) {
  Job job = scanner_job(Mode::rotary);
  const auto on = plan_trajectory(scanner_plan(job));
  ASSERT_TRUE(on) << on.error().message;
  const double count_um = on.value().resolution_mm * 1000;
  EXPECT_LT(on.value().quality.across_um, count_um) << "below the resolution";
  EXPECT_LT(on.value().quality.along_um, count_um);
  job.scanner.cross_scan_correction = false;
  const Plan plan = scanner_plan(job);
  const auto off = plan_trajectory(plan);
  ASSERT_TRUE(off) << off.error().message;
  const double marking_s = 149 / 2e6;  // first to last pulse
  EXPECT_NEAR(off.value().quality.across_um, to_double(plan.rotary.surface_speed_mm_s) * 1000 * marking_s / 2, count_um)
      << "surface speed * marking time / 2";
}

TEST(PlanTrajectory, FollowsTheCarriageAndTheStage) {
  const Plan helical = scanner_plan(scanner_job(Mode::helical));
  const auto screw = plan_geometry(helical);
  ASSERT_TRUE(screw) << screw.error().message;
  const auto slots = static_cast<double>(helical.line.slots);
  EXPECT_NEAR(screw.value().per_slot[1] * slots, 0.008 * 33.3 / 200, 1e-15);
  EXPECT_NEAR(screw.value().per_slot[0] * slots, 2 * std::numbers::pi / 200, 1e-15);
  const Plan flat = scanner_plan(scanner_job(Mode::flat));
  EXPECT_NEAR(plan_geometry(flat).value().per_slot[1] * static_cast<double>(flat.line.slots), 0.008, 1e-12);
  for (const Plan& plan : {helical, flat}) {
    const auto made = plan_trajectory(plan);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_LT(made.value().quality.along_um, made.value().resolution_mm * 1000);
    EXPECT_LT(made.value().quality.across_um, made.value().resolution_mm * 1000);
  }
}

TEST(PlanTrajectory, OfAStageGoingBackwardsMirrorsV) {
  const Plan plan = scanner_plan(scanner_job(Mode::flat));
  const LineTrajectory onwards = plan_trajectory(plan).value();
  const LineTrajectory backwards = plan_trajectory(plan, Sweep::backwards).value();
  for (const Direction direction : {Direction::forward, Direction::reverse}) {
    ASSERT_EQ(onwards.set_points(direction).size(), backwards.set_points(direction).size());
    for (std::size_t k = 0; k < onwards.forward.size(); ++k) {
      EXPECT_EQ(onwards.set_points(direction)[k].u_count, backwards.set_points(direction)[k].u_count);
      EXPECT_EQ(onwards.set_points(direction)[k].v_count, -backwards.set_points(direction)[k].v_count);
    }
  }
  const auto turned = plan_trajectory(scanner_plan(scanner_job(Mode::rotary)), Sweep::backwards);
  ASSERT_FALSE(turned);
  EXPECT_EQ(turned.error().code, ErrorCode::bad_argument);
}

TEST(PlanTrajectory, NamesTheTurnThatWouldDo) {
  Job job = scanner_job(Mode::rotary);
  job.scanner.turn_slots = 40;
  const auto refused = plan_trajectory(scanner_plan(job));
  ASSERT_FALSE(refused);
  const std::string& message = refused.error().message;
  const std::size_t at = message.find("make turn_slots ");
  ASSERT_NE(at, std::string::npos) << message;
  job.scanner.turn_slots = std::stoll(message.substr(at + 16));
  EXPECT_TRUE(plan_trajectory(scanner_plan(job)));
  --job.scanner.turn_slots;
  EXPECT_FALSE(plan_trajectory(scanner_plan(job))) << "one slot fewer is too few";
}

TEST(PlanTrajectory, ReportsTheIncidenceOffTheTop) {
  Job job = scanner_job(Mode::helical);
  job.scanner.offset_deg = -35;
  const auto made = plan_trajectory(scanner_plan(job));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_NEAR(made.value().quality.incidence_deg, 35, 0.5);
  EXPECT_NEAR(made.value().path.geometry().centre_v_mm, -0.8 / std::numbers::pi * std::sin(35 * std::numbers::pi / 180),
              1e-12);
}

TEST(PlanTrajectory, UndoesTheGridOfThePlan) {
  Job job = scanner_job(Mode::rotary);
  FieldGrid grid{2, 2, -20, 20, -20, 20, {}};
  grid.errors.assign(4, GridPoint{0.25, -0.5});
  job.scanner.field_grid_text = field_grid_text(grid);
  const LineTrajectory plain = plan_trajectory(scanner_plan(scanner_job(Mode::rotary))).value();
  const auto made = plan_trajectory(scanner_plan(job));
  ASSERT_TRUE(made) << made.error().message;
  const double count_mm = plain.resolution_mm;
  for (std::size_t k = 0; k < plain.forward.size(); ++k) {
    EXPECT_NEAR(made.value().forward[k].u_count, plain.forward[k].u_count - 0.25 / count_mm, 1);
    EXPECT_NEAR(made.value().forward[k].v_count, plain.forward[k].v_count + 0.5 / count_mm, 1);
  }
  job.scanner.field_grid_text = "gravure-field-grid 1\n";
  const auto broken = plan_trajectory(scanner_plan(job));
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().message.rfind("scanner.field_grid:", 0), 0U) << broken.error().message;
}

TEST(PlanTrajectory, NeedsAScanner) {
  Job job = scanner_job(Mode::rotary);
  job.scanner.field_mm = std::nullopt;
  const auto refused = plan_trajectory(scanner_plan(job));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("scanner.field_mm"), std::string::npos);
}

}  // namespace
}  // namespace gravure::scan
