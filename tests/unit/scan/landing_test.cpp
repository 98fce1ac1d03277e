#include <gtest/gtest.h>

#include <algorithm>

#include "roller.hpp"

namespace gravure::scan {
namespace {

using test::roller_geometry;
using test::roller_head;
using test::roller_lines;
using test::roller_timing;

constexpr double kResolutionUm = 40.0 / (1 << 20) * 1000;  // 38 nm

/// A scanner that knows its path: what remains is geometry.
const LandingModel kIdeal{0, false, false};

LineTrajectory made(const LineTiming& timing, const LineGeometry& geometry, const TrajectoryOptions& options = {}) {
  auto trajectory = make_line_trajectory(timing, geometry, options);
  EXPECT_TRUE(trajectory) << trajectory.error().message;
  return std::move(trajectory).value();
}

TEST(Landing, WithoutCorrectionLinesZigzagByTheWayTheSurfaceMoves) {
  const LineTiming timing = roller_timing();
  const LineTrajectory trajectory = made(timing, roller_geometry(), {false, true, {}});
  const double speed = test::surface_speed_mm_s(timing, roller_lines());
  for (const Direction direction : {Direction::forward, Direction::reverse}) {
    const auto errors = landing_errors(trajectory, direction, kIdeal);
    for (std::size_t pixel = 0; pixel < errors.size(); ++pixel) {
      // The pulse comes so long after the middle of the window, and the surface has moved on by speed * time.
      const double time_s =
          (static_cast<double>(pixel) - 1749.5) * timing.slot_s() * (direction == Direction::forward ? 1 : -1);
      ASSERT_NEAR(errors[pixel].across_um, speed * time_s * 1000, 1e-6) << pixel;
      ASSERT_NEAR(errors[pixel].along_um, 0, 1e-9);
    }
  }
  // Amplitude of the zigzag: half of surface speed times marking time, a third of a pitch here.
  EXPECT_NEAR(trajectory.quality.across_um, speed * 1749.5 * timing.slot_s() * 1000, kResolutionUm);
  EXPECT_NEAR(trajectory.quality.across_um, 8.0 * 1749.5 / 5400, 0.02);
}

TEST(Landing, WithCorrectionTheErrorIsBelowTheResolutionOfTheGalvo) {
  const LineTrajectory trajectory = made(roller_timing(), roller_geometry());
  EXPECT_LT(trajectory.quality.across_um, kResolutionUm);
  EXPECT_LT(trajectory.quality.along_um, kResolutionUm);
  EXPECT_LT(trajectory.quality.interpolation_um, 1e-6);
  for (const Direction direction : {Direction::forward, Direction::reverse}) {
    for (const LandingError& error : landing_errors(trajectory, direction, kIdeal)) {
      ASSERT_LT(std::hypot(error.along_um, error.across_um), 1e-9);
    }
  }
}

TEST(Landing, TheFirstAndTheLastPixelAreAsGoodAsTheOthers) {
  // Windows and set-points out of step, and a lag that moves the set-points within their microvectors.
  for (const std::int64_t first : {945, 950, 957, 960}) {
    LineTiming timing = roller_timing();
    timing.forward_first_slot = first;
    timing.reverse_first_slot = timing.slots - timing.pixels - first;
    kinematics::ScanHead head = roller_head();
    head.lag_us = ratio(7, 2);
    const LineTrajectory trajectory = made(timing, roller_geometry(timing, head));
    EXPECT_LT(trajectory.quality.interpolation_um, 1e-6) << first;
  }
}

TEST(Landing, UncompensatedLagShiftsOddAgainstEvenLinesByTwiceSpeedTimesLag) {
  const LineTiming timing = roller_timing();
  kinematics::ScanHead head = roller_head();
  head.lag_us = 3;
  const LineTrajectory late = made(timing, roller_geometry(timing, head), {true, false, {}});
  const LandingModel model{3, false, true};
  const double speed = 16'000;
  const double shift_um = landing_error(late, Direction::forward, 1750, model).along_um -
                          landing_error(late, Direction::reverse, 1750, model).along_um;
  EXPECT_NEAR(shift_um, -2 * speed * 3e-6 * 1000, 1e-6);  // 96 um

  const LineTrajectory compensated = made(timing, roller_geometry(timing, head));
  EXPECT_EQ(compensated.lag_ticks, 492);  // 3 us at 164 MHz, exact
  EXPECT_EQ(compensated.lag_remainder_ticks, 0);
  EXPECT_LT(compensated.quality.along_um, kResolutionUm);
  EXPECT_LT(compensated.quality.across_um, kResolutionUm);
}

TEST(Landing, DelayedPulsesOfReverseLinesCompensateTwiceTheLag) {
  LineTiming timing = roller_timing();
  timing.offset_slots = 12;  // 6 us
  timing.reverse_first_slot += 12;
  kinematics::ScanHead head = roller_head();
  head.lag_us = 3;
  const LineTrajectory trajectory = made(timing, roller_geometry(timing, head), {true, false, {}});
  const LandingModel model{3, false, true};
  for (const std::int64_t pixel : {10, 1750, 3490}) {
    EXPECT_NEAR(landing_error(trajectory, Direction::forward, pixel, model).along_um,
                landing_error(trajectory, Direction::reverse, pixel, model).along_um, 1e-6)
        << pixel;
  }
}

TEST(Landing, WhatWholeTicksLeaveOfTheLagIsReported) {
  kinematics::ScanHead head = roller_head();
  head.lag_us = ratio(12'345, 1000);
  const LineTrajectory trajectory = made(roller_timing(), roller_geometry(roller_timing(), head));
  EXPECT_EQ(trajectory.lag_ticks, 2025);  // 12.345 us * 164 MHz = 2024.58
  EXPECT_EQ(trajectory.lag_remainder_ticks, ratio(-42, 100));
  const double along_um =
      landing_error(trajectory, Direction::forward, 1000, {to_double(head.lag_us), false, true}).along_um;
  EXPECT_NEAR(along_um, 0.42 / 164e6 * 16'000 * 1000, 1e-6);
  head.lag_us = 2700;
  EXPECT_FALSE(make_line_trajectory(roller_timing(), roller_geometry(roller_timing(), head), {}));
}

TEST(Landing, FollowsTheArcWhereAStraightPathWouldMiss) {
  const LineTiming timing = roller_timing();
  const auto geometry = cylinder_geometry(timing, test::tube_lines(), roller_head());
  ASSERT_TRUE(geometry) << geometry.error().message;
  const LineTrajectory trajectory = made(timing, geometry.value());
  const double radius = 0.9;
  const double angle = 2 * test::kPi / 40 * 1749.5 / 5400;  // turned from the middle to the end of the window
  EXPECT_NEAR(trajectory.quality.straight_um, radius * (angle - std::sin(angle)) * 1000, 1e-3);
  EXPECT_GT(trajectory.quality.straight_um, 0.01);
  EXPECT_NEAR(trajectory.quality.defocus_um, radius * (1 - std::cos(angle)) * 1000, 1e-3);
  EXPECT_LT(trajectory.quality.across_um, kResolutionUm);
  for (const LandingError& error : landing_errors(trajectory, Direction::forward, kIdeal)) {
    ASSERT_LT(std::hypot(error.along_um, error.across_um), 1e-9);
    ASSERT_LE(error.defocus_um, 1e-9) << "the surface sinks on both sides";
  }
}

TEST(Landing, LongMicrovectorsLeaveChordsOnTheArc) {
  LineTiming timing = roller_timing();
  timing.slots_per_microvector = 600;
  timing.pixels = 2400;
  timing.forward_first_slot = timing.reverse_first_slot = 1500;
  const auto geometry = cylinder_geometry(timing, test::tube_lines(), roller_head());
  const LineTrajectory trajectory = made(timing, geometry.value());
  // Set-points at slots 1800 and 2400: half way between them V is on the chord, the surface on the arc.
  const double per_slot = 2 * test::kPi / 40 / 5400;
  const double angle = per_slot * (2100 - 2699.5);
  const double sagitta_um = 0.9 * std::sin(angle) * (1 - std::cos(per_slot * 300)) * 1000;
  const double across_um = landing_error(trajectory, Direction::forward, 600, {0, false, true}).across_um;
  EXPECT_NEAR(std::abs(across_um), std::abs(sagitta_um), std::abs(sagitta_um) * 0.01);
  EXPECT_GE(trajectory.quality.interpolation_um, std::abs(across_um));
}

TEST(Landing, OfReverseLinesIsLaterByTheRemainderOfTheOffset) {
  LineTiming timing = roller_timing();
  timing.offset_remainder_ticks = 41;  // half a slot, so half a pixel of 8 um
  const LineTrajectory trajectory = made(timing, roller_geometry(timing));
  const LandingModel exact{0, false, true};
  for (const std::int64_t pixel : {0, 1700, 3499}) {
    EXPECT_NEAR(landing_error(trajectory, Direction::forward, pixel, exact).along_um, 0, 1e-6);
    EXPECT_NEAR(landing_error(trajectory, Direction::reverse, pixel, exact).along_um, -4, 1e-6);
  }
}

TEST(Landing, HoldsOffAxisWithTheIncidenceReported) {
  const LineTiming timing = roller_timing();
  CylinderLines lines = roller_lines();
  lines.offset_deg = 20;
  const auto geometry = cylinder_geometry(timing, lines, roller_head());
  ASSERT_TRUE(geometry) << geometry.error().message;
  EXPECT_NEAR(geometry.value().centre_v_mm, 35 * std::sin(test::kPi / 9), 1e-12);
  const LineTrajectory trajectory = made(timing, geometry.value());
  EXPECT_NEAR(trajectory.quality.incidence_deg, 20, 0.01);
  EXPECT_LT(trajectory.quality.across_um, kResolutionUm / std::cos(test::kPi / 9))
      << "slanting light stretches a count";
  EXPECT_GT(trajectory.quality.defocus_um, 0.5) << "the surface rises under slanting light";
  lines.offset_deg = 60;
  const auto beyond = cylinder_geometry(timing, lines, roller_head());
  const auto refused = make_line_trajectory(timing, beyond.value(), {});
  ASSERT_FALSE(refused) << "30 mm beside the centre of a 40 mm field";
  EXPECT_NE(refused.error().message.find("field_mm = 40"), std::string::npos) << refused.error().message;
}

TEST(Landing, HoldsNearlyTangential) {
  const LineTiming timing = roller_timing();
  CylinderLines lines = test::tube_lines();
  lines.lines_per_revolution = 900;
  lines.offset_deg = -80;
  const auto geometry = cylinder_geometry(timing, lines, roller_head());
  ASSERT_TRUE(geometry) << geometry.error().message;
  const LineTrajectory trajectory = made(timing, geometry.value());
  EXPECT_NEAR(trajectory.quality.incidence_deg, 80, 0.2);
  for (const LandingError& error : landing_errors(trajectory, Direction::reverse, kIdeal)) {
    ASSERT_LT(std::hypot(error.along_um, error.across_um), 1e-9);
  }
}

TEST(Landing, HelicalCarriageIsTakenUpByU) {
  const LineTiming timing = roller_timing();
  CylinderLines lines = roller_lines();
  lines.carriage_mm_per_line = 0.05;
  const auto geometry = cylinder_geometry(timing, lines, roller_head());
  const LineTrajectory trajectory = made(timing, geometry.value());
  EXPECT_LT(trajectory.quality.along_um, kResolutionUm);
  const double first = trajectory.path.at(Direction::forward, 950).u_mm;
  const double last = trajectory.path.at(Direction::forward, 950 + 3499).u_mm;
  EXPECT_NEAR(last - first, 0.008 * 3499 - 0.05 * 3499 / 5400, 1e-9);
}

TEST(Landing, AWorkpieceThickerByTenMicrometresHasAWiderPitchAndAClosedSeam) {
  const LineGeometry geometry = roller_geometry();
  const double per_line = geometry.per_slot[0] * 5400;
  const auto marked = [&geometry, per_line](int line) {  // the surface is 5 um nearer to the head
    return kinematics::forward(geometry.machine, kinematics::JointPositions{per_line * line, 0, 0}, {0, 0, 0.005})
        .position_mm;
  };
  const double pitch_um = (marked(1) - marked(0)).norm() * 1000;
  EXPECT_NEAR(pitch_um / (test::kPi * 70 / 27'489 * 1000), 70.01 / 70, 1e-6);
  EXPECT_LT((marked(27'489) - marked(0)).norm(), 1e-9);
}

TEST(Landing, OfAFlatPanelIsTheSameCode) {
  const LineTiming timing = roller_timing();
  const LineGeometry geometry = plane_geometry(timing, {0.008, 0.008}, roller_head()).value();
  const LineTrajectory on = made(timing, geometry);
  const LineTrajectory off = made(timing, geometry, {false, true, {}});
  EXPECT_LT(on.quality.across_um, kResolutionUm);
  EXPECT_NEAR(on.quality.defocus_um, 0, 1e-9);
  EXPECT_NEAR(on.quality.straight_um, 0, 1e-9);
  EXPECT_NEAR(off.quality.across_um, 8 * 1749.5 / 5400, kResolutionUm);
}

TEST(Landing, LinesAreEvenlySpacedWhereWindowsAreNot) {
  LineTiming timing = roller_timing();
  timing.offset_slots = 100;
  timing.reverse_first_slot += 100;
  kinematics::ScanHead head = roller_head();
  const LineTrajectory trajectory = made(timing, roller_geometry(timing, head));
  for (const LandingError& error : landing_errors(trajectory, Direction::reverse, kIdeal)) {
    ASSERT_NEAR(error.across_um, 0, 0.15 * 0.02) << "the pulses are later than the path and the surface";
  }
}

TEST(Landing, HoldsWithAnFThetaLens) {
  kinematics::ScanHead head = roller_head();
  head.lens = kinematics::Lens::f_theta;
  head.tilt_rad_per_mm = 0.01;
  const LineTiming timing = roller_timing();
  const auto geometry = cylinder_geometry(timing, test::tube_lines(), head);
  const LineTrajectory trajectory = made(timing, geometry.value());
  const double tilt = 0.01 * 1749.5 * 0.006;
  const double turned = 2 * test::kPi / 40 * 1749.5 / 5400;
  EXPECT_NEAR(trajectory.quality.incidence_deg, std::acos(std::cos(tilt) * std::cos(turned)) * 180 / test::kPi, 0.02);
  for (const LandingError& error : landing_errors(trajectory, Direction::forward, kIdeal)) {
    ASSERT_LT(std::hypot(error.along_um, error.across_um), 1e-8);
  }
}

}  // namespace
}  // namespace gravure::scan
