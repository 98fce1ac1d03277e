#include "gravure/scan/job_trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "plans.hpp"

namespace gravure::scan {
namespace {

using test::scanner_job;
using test::scanner_plan;

constexpr LandingModel kIdealMirrors{0, false, false};
constexpr double kNothing_mm = 1e-9;  // 1e-6 um

JobTrajectory made(const Plan& plan) {
  auto job = JobTrajectory::make(plan);
  EXPECT_TRUE(job) << job.error().message;
  return std::move(job).value();
}

/// Every pulse of some lines against the column and line of the image that ExposureMap gives it.
void expect_on_target(const Plan& plan) {
  const JobTrajectory job = made(plan);
  const ExposureMap map(plan);
  const double pitch_mm = to_double(plan.line.pixel_pitch_um) / 1000;
  const double line_mm = to_double(plan.rotary.line_pitch_um) / 1000;
  const double radius_mm = to_double(plan.rotary.circumference_um) / 1000 / 6.283185307179586;
  int pulses = 0;
  for (std::int64_t revolution = 0; revolution < plan.job.revolutions; ++revolution) {
    for (const std::int64_t line : {0L, 1L, 2L, 77L, 198L, 199L}) {
      const LineNumber number{revolution, line};
      const LineTiming& timing = job.of_revolution(revolution).path.timing();
      for (std::int64_t index = 0; index < map.stretches(); ++index) {
        const Stretch stretch = map.stretch(revolution, line, index);
        for (std::int64_t i = 0; i < stretch.columns; i += 7) {
          const std::int64_t slot = timing.slot_of_pixel(job.direction_of(number), stretch.first_pixel + i);
          const auto state = job.at(number, slot, kIdealMirrors);
          ASSERT_TRUE(state) << state.error().message;
          const kinematics::Vector3& spot = state.value().spot_mm;
          const auto image_line = static_cast<double>(map.image_line(revolution, line));
          const double across = image_line * line_mm;
          ASSERT_NEAR(spot.x(), static_cast<double>(stretch.first_column + i) * pitch_mm, kNothing_mm)
              << "revolution " << revolution << ", line " << line << ", pixel " << stretch.first_pixel + i;
          ASSERT_NEAR(spot.y(), plan.mode == Mode::flat ? across : radius_mm * std::sin(across / radius_mm),
                      kNothing_mm);
          ASSERT_NEAR(spot.z(), plan.mode == Mode::flat ? 0 : radius_mm * std::cos(across / radius_mm), kNothing_mm);
          ASSERT_NEAR((job.target_of(number, stretch.first_pixel + i) - spot).norm(), 0, kNothing_mm);
          ++pulses;
        }
      }
    }
  }
  EXPECT_GT(pulses, 200);
}

TEST(JobTrajectory, PutsEveryPulseOnItsColumnAndLineInEveryMode) {
  for (const Mode mode : {Mode::rotary, Mode::helical, Mode::flat}) {
    SCOPED_TRACE(mode_name(mode));
    expect_on_target(scanner_plan(scanner_job(mode)));
  }
}

TEST(JobTrajectory, PutsEveryPulseOnItsColumnInBands) {
  for (const Mode mode : {Mode::rotary, Mode::flat}) {
    SCOPED_TRACE(mode_name(mode));
    Job job = scanner_job(mode);
    job.scanner.field_mm = ratio(64 * 8, 1000);
    const Plan plan = scanner_plan(job);
    ASSERT_TRUE(plan.bands);
    expect_on_target(plan);
  }
}

TEST(JobTrajectory, PutsEveryPulseOnItsColumnWithLagAndOneDirection) {
  Job job = scanner_job(Mode::helical);
  job.scanner.lag_us = ratio(125, 10);
  job.scanner.bidirectional = false;
  job.scanner.turn_slots = 3500;
  const Plan plan = scanner_plan(job);
  const JobTrajectory trajectory = made(plan);
  const LineNumber number{4, 123};
  const auto slot = plan.line.forward_first_slot + 30;
  const auto spot = trajectory.at(number, slot, {12.5, false, false}).value().spot_mm;
  EXPECT_NEAR((spot - trajectory.target_of(number, 30)).norm(), 0, kNothing_mm) << "compensated to the tick: 2050";
  const auto late = trajectory.at(number, slot, {15.5, false, false}).value().spot_mm;
  EXPECT_NEAR(late.x() - spot.x(), -0.048, 1e-5) << "3 us more at 16 m/s";
}

TEST(JobTrajectory, StaysWithinACountAndAHalfWithRealSetPoints) {
  for (const Mode mode : {Mode::rotary, Mode::helical, Mode::flat}) {
    SCOPED_TRACE(mode_name(mode));
    const Plan plan = scanner_plan(scanner_job(mode));
    const JobTrajectory job = made(plan);
    const double count_mm = job.of_revolution(0).resolution_mm;
    for (std::int64_t line = 0; line < 20; ++line) {
      const LineNumber number{1, line};
      for (std::int64_t pixel = 0; pixel < plan.line.pixels; pixel += 3) {
        const auto slot = job.of_revolution(1).path.timing().slot_of_pixel(job.direction_of(number), pixel);
        const auto state = job.at(number, slot, {0, true, true});
        ASSERT_TRUE(state) << state.error().message;
        ASSERT_LT((state.value().spot_mm - job.target_of(number, pixel)).cwiseAbs().maxCoeff(), 1.5 * count_mm);
      }
    }
  }
}

TEST(JobTrajectory, LinesOfOneDirectionHaveTheSameSetPoints) {
  const JobTrajectory job = made(scanner_plan(scanner_job(Mode::rotary)));
  const auto first = job.set_points({0, 0}).value();
  for (const LineNumber number : {LineNumber{0, 2}, LineNumber{1, 198}}) {
    const auto again = job.set_points(number).value();
    ASSERT_EQ(again.size(), first.size());
    for (std::size_t k = 0; k < first.size(); ++k) {
      ASSERT_EQ(again[k].u_count, first[k].u_count);
      ASSERT_EQ(again[k].v_count, first[k].v_count);
    }
  }
}

TEST(JobTrajectory, HelicalLinesShiftUByTheFractionAndBlendItInTheTurn) {
  const Plan plan = scanner_plan(scanner_job(Mode::helical));
  const JobTrajectory job = made(plan);
  const LinePath& path = job.of_revolution(0).path;
  double largest_step = 0;
  for (std::int64_t line = 0; line < 40; ++line) {
    const LineNumber number{2, line};
    const double fraction = to_double(helical_window(plan, 2, line).fraction);
    const LinePath::Window marks = path.marking(job.direction_of(number));
    EXPECT_NEAR(job.shift_mm(number, marks.begin), -fraction * 0.008, 1e-15);
    EXPECT_NEAR(job.shift_mm(number, marks.end), -fraction * 0.008, 1e-15);
    EXPECT_NEAR(job.shift_mm(number, static_cast<double>(plan.line.slots)), job.shift_mm({2, line + 1}, 0), 1e-15)
        << "one line's end is the next one's start";
    for (std::int64_t slot = 0; slot < plan.line.slots; ++slot) {
      const double step =
          job.shift_mm(number, static_cast<double>(slot + 1)) - job.shift_mm(number, static_cast<double>(slot));
      largest_step = std::max(largest_step, std::abs(step));
    }
  }
  EXPECT_LT(largest_step, 2 * 0.008 / 1700) << "the whole turn is used, also where the fraction wraps";
  EXPECT_GT(largest_step, 0.008 / 1800);
}

TEST(JobTrajectory, StoresTheSetPointsOfEveryKindOfLine) {
  const JobTrajectory rotary = made(scanner_plan(scanner_job(Mode::rotary)));
  EXPECT_EQ(rotary.stored_set_points().size(), 2U);
  const JobTrajectory flat = made(scanner_plan(scanner_job(Mode::flat)));
  const auto kinds = flat.stored_set_points();
  ASSERT_EQ(kinds.size(), 4U);
  for (const LineSetPoints& kind : kinds) {
    const LineNumber number{kind.backwards ? 1 : 0, kind.reverse ? 1 : 0};
    const auto points = flat.set_points(number).value();
    ASSERT_EQ(kind.u_counts.size(), points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      ASSERT_EQ(kind.u_counts[k], points[k].u_count);
      ASSERT_EQ(kind.v_counts[k], points[k].v_count);
    }
  }
  Job one_way = scanner_job(Mode::rotary);
  one_way.scanner.bidirectional = false;
  one_way.scanner.turn_slots = 3500;
  EXPECT_EQ(made(scanner_plan(one_way)).stored_set_points().size(), 1U);
}

TEST(JobTrajectory, CountsTicksAndTurnsFromTheStartOfTheJob) {
  Job settings = scanner_job(Mode::rotary);
  settings.scanner.bidirectional_offset_ticks = 100;
  const Plan plan = scanner_plan(settings);
  ASSERT_EQ(plan.line.offset_remainder_ticks, 18);
  const JobTrajectory job = made(plan);
  const auto state = job.at({1, 3}, 5, kIdealMirrors).value();
  EXPECT_EQ(state.tick, (203 * plan.line.slots + 5) * 82 + 18) << "reverse lines fire later by the remainder";
  EXPECT_NEAR(state.joints[0], 6.283185307179586 * 203 / 200, 0.04);
}

}  // namespace
}  // namespace gravure::scan
