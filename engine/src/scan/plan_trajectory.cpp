#include "gravure/scan/plan_trajectory.hpp"

#include <numbers>

namespace gravure::scan {
namespace {

std::optional<double> number_of(const std::optional<Rational>& value) {
  return value ? std::optional(to_double(*value)) : std::nullopt;
}

Result<void> check_has_scanner(const Plan& plan) {
  if (plan.scanner) {
    return {};
  }
  return Error{ErrorCode::bad_argument,
               "scan: the plan has no scanner: give scanner.field_mm in the job, or a machine file"};
}

}  // namespace

kinematics::ScanHead scan_head(const ScannerPlan& scanner) {
  kinematics::ScanHead head;
  head.lens = scanner.tilt_deg_per_mm > 0 ? kinematics::Lens::f_theta : kinematics::Lens::telecentric;
  head.tilt_rad_per_mm = to_double(scanner.tilt_deg_per_mm) * std::numbers::pi / 180;
  head.field_mm = to_double(scanner.field_mm);
  head.resolution_bits = scanner.resolution_bits;
  head.lag_us = scanner.lag_us;
  head.max_speed_mm_s = number_of(scanner.max_speed_mm_s);
  head.max_acceleration_mm_s2 = number_of(scanner.max_acceleration_mm_s2);
  head.max_jerk_mm_s3 = number_of(scanner.max_jerk_mm_s3);
  return head;
}

Result<LineGeometry> plan_geometry(const Plan& plan, Sweep sweep) {
  GRAVURE_CHECK(check_has_scanner(plan));
  const LineTiming timing = line_timing(plan);
  const kinematics::ScanHead head = scan_head(*plan.scanner);
  if (plan.mode != Mode::flat) {
    if (sweep == Sweep::backwards) {
      return Error{ErrorCode::bad_argument, "scan: a workpiece that turns is not swept backwards"};
    }
    CylinderLines lines = cylinder_lines(plan, to_double(plan.scanner->offset_deg));
    if (plan.carriage) {
      lines.carriage_mm_per_line =
          to_double(plan.carriage->feed_um / Rational(1000) / Rational(plan.rotary.lines_per_revolution));
    }
    return cylinder_geometry(timing, lines, head);
  }
  const PlaneLines lines{to_double(plan.rotary.line_pitch_um) / 1000, to_double(plan.line.pixel_pitch_um) / 1000};
  GRAVURE_TRY(LineGeometry geometry, plane_geometry(timing, lines, head));
  if (sweep == Sweep::backwards) {
    for (double& step : geometry.per_slot) {
      step = -step;
    }
  }
  return geometry;
}

Result<LineTrajectory> plan_trajectory(const Plan& plan, Sweep sweep) {
  GRAVURE_TRY(const LineGeometry geometry, plan_geometry(plan, sweep));
  TrajectoryOptions options{plan.scanner->cross_scan_correction, plan.scanner->compensate_lag, std::nullopt};
  if (!plan.scanner->field_grid.empty()) {
    GRAVURE_TRY(options.field_grid, parse_field_grid(plan.scanner->field_grid, "scanner.field_grid"));
  }
  return make_line_trajectory(line_timing(plan), geometry, options);
}

}  // namespace gravure::scan
