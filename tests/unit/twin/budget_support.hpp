#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "error_model.hpp"
#include "gravure/sync/make_plan.hpp"
#include "small_job.hpp"

namespace gravure::test {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kRollerCountUm = 40.0 / (1 << 20) * 1000;  ///< 20 bits over 40 mm

/// The large roller of [B]: 16 m/s, 8 um pixels and lines, 70 mm diameter, 28 mm of 5400 slots a line marked.
inline Job roller_job() {
  Job job = small_job(27'489);
  job.scanner.slots_per_microvector = 20;
  job.scanner.turn_slots = 1900;
  job.scanner.bidirectional_offset_ticks = 0;
  job.rotary.circumference_mm.reset();
  job.rotary.diameter_mm = 70;
  job.rotary.encoder_lines = 11'840;
  job.rotary.interpolation_bits = 13;
  job.rotary.max_ab_hz = 2'000'000;
  return job;
}

inline kinematics::ScanHead roller_head() {
  kinematics::ScanHead head;
  head.field_mm = 40;
  head.resolution_bits = 20;
  return head;
}

inline Plan plan_of(const Job& job, std::int64_t columns, std::int64_t exposures) {
  Result<Plan> plan = make_plan(job, columns, exposures);
  EXPECT_TRUE(plan) << plan.error().message;
  return std::move(plan).value();
}

/// What the scanner does in the lines of a plan.
inline scan::LineTrajectory trajectory_of(const Plan& plan, const kinematics::ScanHead& head,
                                          const scan::TrajectoryOptions& options = {}, double offset_deg = 0) {
  const scan::LineTiming timing = scan::line_timing(plan);
  scan::CylinderLines lines = scan::cylinder_lines(plan, offset_deg);
  if (plan.carriage) {
    lines.carriage_mm_per_line =
        to_double(plan.carriage->feed_um) / 1000 / static_cast<double>(plan.rotary.lines_per_revolution);
  }
  const auto geometry =
      plan.mode == Mode::flat
          ? scan::plane_geometry(
                timing, {to_double(plan.rotary.line_pitch_um) / 1000, to_double(plan.line.pixel_pitch_um) / 1000}, head)
          : scan::cylinder_geometry(timing, lines, head);
  EXPECT_TRUE(geometry) << geometry.error().message;
  auto trajectory = scan::make_line_trajectory(timing, geometry.value(), options);
  EXPECT_TRUE(trajectory) << trajectory.error().message;
  return std::move(trajectory).value();
}

/// Every term off.
inline TwinSettings no_terms() {
  TwinSettings twin;
  twin.drift = twin.ab_step = twin.galvo_resolution = twin.microvectors = twin.cross_scan = twin.lag = twin.defocus =
      false;
  return twin;
}

inline TwinSettings scanner_terms() {
  TwinSettings twin = no_terms();
  twin.galvo_resolution = twin.microvectors = twin.cross_scan = twin.lag = twin.defocus = true;
  return twin;
}

inline ErrorModel model_of(const Plan& plan, const scan::LineTrajectory* trajectory, const TwinSettings& twin) {
  Result<ErrorModel> model = ErrorModel::make(plan, trajectory, twin);
  EXPECT_TRUE(model) << model.error().message;
  return std::move(model).value();
}

}  // namespace gravure::test
