#include "gravure/scan/line_trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gravure/core/units.hpp"
#include "gravure/scan/landing.hpp"
#include "set_point_at.hpp"

namespace gravure::scan {
namespace {

using kinematics::FieldPoint;
using kinematics::ScanHead;

constexpr double kDegrees = 180 / 3.14159265358979323846;

Result<std::vector<SetPoint>> set_points(const LineTrajectory& trajectory, Direction direction) {
  const LineTiming& timing = trajectory.path.timing();
  const std::int64_t count = timing.slots / timing.slots_per_microvector;
  std::vector<SetPoint> points;
  points.reserve(static_cast<std::size_t>(count));
  for (std::int64_t k = 0; k < count; ++k) {
    GRAVURE_TRY(const SetPoint point,
                set_point_at(trajectory, direction, set_point_slot(timing, trajectory.lag_ticks, k), 0));
    points.push_back(point);
  }
  return points;
}

Result<void> check_size(const LineTiming& timing) {
  const std::int64_t points = timing.slots / timing.slots_per_microvector;
  if (points > kMostPulsesPerLine) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("scan: {} set-points a line, one every slots_per_microvector = {} of its {} slots: at most "
                    "{} fit; take more slots_per_microvector or fewer turn_slots",
                    points, timing.slots_per_microvector, timing.slots, kMostPulsesPerLine)};
  }
  if (timing.pixels > kMostPulsesPerLine) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("scan: {} pixels a line of field_mm: at most {} fit; take a larger pixel pitch, or a smaller "
                    "field and more bands",
                    timing.pixels, kMostPulsesPerLine)};
  }
  return {};
}

/// The field grid may shift an order for a place within the field out of it.
Result<void> check_orders(const LineTrajectory& trajectory, Direction direction) {
  const LinePath& path = trajectory.path;
  const LineTiming& timing = path.timing();
  const double field_mm = path.geometry().machine.head.field_mm;
  const double first = static_cast<double>(timing.first_slot(direction));
  for (std::int64_t i = 0; i < timing.pixels; ++i) {
    const FieldPoint wanted = path.on_line(direction, first + static_cast<double>(i));
    GRAVURE_TRY(const GridPoint order, trajectory.options.field_grid->command_for({wanted.u_mm, wanted.v_mm}));
    const double farthest = std::max(std::abs(order.u_mm), std::abs(order.v_mm));
    if (farthest > field_mm / 2) {
      return Error{ErrorCode::out_of_range,
                   fmt::format("scan: field_grid has the pulse at U = {:.6g}, V = {:.6g} mm ordered to U = {:.6g}, V = "
                               "{:.6g} mm, outside the field: field_mm = {} reaches {}; it takes a field of {:.6g} mm, "
                               "or fewer pixels",
                               wanted.u_mm, wanted.v_mm, order.u_mm, order.v_mm, field_mm, field_mm / 2, 2 * farthest)};
    }
  }
  return {};
}

struct Lag {
  std::int64_t ticks = 0;
  Rational remainder_ticks = 0;
};

/// The nearest whole ticks and what they leave.
Result<Lag> lag_of(const LineTiming& timing, const ScanHead& head) {
  const Rational lag = head.lag_us * Rational(timing.fpga_hz) / Rational(1'000'000);
  if (lag >= Rational(timing.ticks())) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("scan: lag_us = {}: longer than a line of {} FPGA ticks; at most {:.6g} us fit",
                             to_decimal_string(head.lag_us), timing.ticks(),
                             static_cast<double>(timing.ticks() - 1) / static_cast<double>(timing.fpga_hz) * 1e6)};
  }
  Lag result;
  GRAVURE_TRY(result.ticks, to_int64(round_of(lag), "lag_us"));
  result.remainder_ticks = lag - Rational(result.ticks);
  return result;
}

/// Widens `quality` by one direction's lines.
void measure(const LineTrajectory& trajectory, Direction direction, LineQuality& quality) {
  const LinePath& path = trajectory.path;
  const LineTiming& timing = path.timing();
  const kinematics::Vector3& normal = path.geometry().surface_normal;
  LandingModel real = landing_model(trajectory);
  LandingModel unrounded = real;
  unrounded.rounding = false;
  const auto centre = static_cast<double>(timing.first_slot(direction)) + static_cast<double>(timing.pixels - 1) / 2;
  const double v_speed = path.on_line(direction, centre + 0.5).v_mm - path.on_line(direction, centre - 0.5).v_mm;
  const double v_centre = path.on_line(direction, centre).v_mm;
  const auto widen = [](double& most, double value) { most = std::max(most, std::abs(value)); };
  for (std::int64_t pixel = 0; pixel < timing.pixels; ++pixel) {
    const LandingError error = landing_error(trajectory, direction, pixel, real);
    widen(quality.along_um, error.along_um);
    widen(quality.across_um, error.across_um);
    widen(quality.defocus_um, error.defocus_um);
    const LandingError chord = landing_error(trajectory, direction, pixel, unrounded);
    widen(quality.interpolation_um, std::hypot(chord.along_um, chord.across_um));
    const auto slot = static_cast<double>(timing.slot_of_pixel(direction, pixel));
    const FieldPoint field = path.on_line(direction, slot);
    widen(quality.straight_um, (field.v_mm - v_centre - v_speed * (slot - centre)) * kUmPerMm);
    const auto spot = kinematics::forward(path.geometry().machine, path.joints_at(slot), field);
    widen(quality.incidence_deg, std::acos(std::min(1.0, spot.towards_head.dot(normal))) * kDegrees);
  }
}

/// One warning for all limits that are absent, so that jobs of before say it once.
void warn_of_absent_limits(const ScanHead& head, std::vector<std::string>& warnings) {
  std::string absent;
  const auto note = [&absent](const char* field, const std::optional<double>& limit) {
    absent += limit ? "" : (absent.empty() ? "scanner." : ", ") + std::string(field);
  };
  note("max_speed_mm_s", head.max_speed_mm_s);
  note("max_acceleration_mm_s2", head.max_acceleration_mm_s2);
  note("max_jerk_mm_s3", head.max_jerk_mm_s3);
  if (!absent.empty()) {
    warnings.push_back(absent + ": absent, so lines and turns are not checked against " +
                       (absent.find(',') == std::string::npos ? "it" : "them"));
  }
}

/// How far from the centre either mirror is ordered, field correction included.
double ordered_mm(const LineTrajectory& trajectory) {
  std::int64_t most = 0;
  for (const std::vector<SetPoint>* points : {&trajectory.forward, &trajectory.reverse}) {
    for (const SetPoint& point : *points) {
      most = std::max({most, std::abs(std::int64_t{point.u_count}), std::abs(std::int64_t{point.v_count})});
    }
  }
  return static_cast<double>(most) * trajectory.resolution_mm;
}

void warn_of_reach(const LineTrajectory& trajectory, std::vector<std::string>& warnings) {
  const double field_mm = trajectory.path.geometry().machine.head.field_mm;
  const double reach_mm = trajectory.options.field_grid
                              ? std::max(trajectory.path.reach_mm(), ordered_mm(trajectory) - trajectory.resolution_mm)
                              : trajectory.path.reach_mm();
  if (reach_mm > field_mm / 2) {
    warnings.push_back(fmt::format(
        "the turn swings to {:.6g} mm from the centre, beyond the {:.6g} mm of scanner.field_mm = {:.6g}: the scanner "
        "must "
        "reach that far beyond what it marks (a field of {:.6g} mm would hold it); frames for export cannot carry it",
        reach_mm, field_mm / 2, field_mm, 2 * reach_mm));
  }
}

/// Joints run at constant speed while lines are marked.
Result<void> check_joint_speeds(const LineTiming& timing, const LineGeometry& geometry) {
  for (std::size_t i = 0; i < geometry.per_slot.size(); ++i) {
    const kinematics::Joint& joint = geometry.machine.joints[i];
    const double speed = std::abs(geometry.per_slot[i]) / timing.slot_s();
    if (joint.limits.max_speed && speed > *joint.limits.max_speed) {
      return Error{ErrorCode::out_of_range,
                   fmt::format("scan: joint {} moves at {:.9g} {}: its max_speed is {:.9g}; take fewer lines a second",
                               joint.name, speed, joint.kind == kinematics::JointKind::prismatic ? "mm/s" : "rad/s",
                               *joint.limits.max_speed)};
    }
  }
  return {};
}

}  // namespace

Result<LineTrajectory> make_line_trajectory(const LineTiming& timing, const LineGeometry& geometry,
                                            const TrajectoryOptions& options) {
  GRAVURE_CHECK(check_timing(timing));
  GRAVURE_CHECK(kinematics::check_machine(geometry.machine));
  if (geometry.at_centre.size() != geometry.machine.joints.size() ||
      geometry.per_slot.size() != geometry.machine.joints.size()) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("scan: at_centre has {} and per_slot {} positions: the machine has "
                             "{} joints",
                             geometry.at_centre.size(), geometry.per_slot.size(), geometry.machine.joints.size())};
  }
  GRAVURE_CHECK(check_joint_speeds(timing, geometry));
  GRAVURE_CHECK(check_size(timing));
  const ScanHead& head = geometry.machine.head;
  Lag lag;
  if (options.lag_compensation) {
    GRAVURE_TRY(lag, lag_of(timing, head));
  }
  GRAVURE_TRY(LinePath path, LinePath::plan(timing, geometry, options.cross_scan_correction, lag.ticks));
  LineTrajectory trajectory{std::move(path),
                            options,
                            std::ldexp(head.field_mm, -head.resolution_bits),
                            geometry.pixel_pitch_mm / timing.slot_s(),
                            lag.ticks,
                            lag.remainder_ticks,
                            {},
                            {},
                            {},
                            0,
                            {}};
  if (options.field_grid) {
    GRAVURE_CHECK(check_orders(trajectory, Direction::forward));
    GRAVURE_CHECK(timing.bidirectional ? check_orders(trajectory, Direction::reverse) : Result<void>());
  }
  GRAVURE_TRY(trajectory.forward, set_points(trajectory, Direction::forward));
  if (timing.bidirectional) {
    GRAVURE_TRY(trajectory.reverse, set_points(trajectory, Direction::reverse));
  }
  measure(trajectory, Direction::forward, trajectory.quality);
  if (timing.bidirectional) {
    measure(trajectory, Direction::reverse, trajectory.quality);
  }
  if (options.field_grid) {
    trajectory.field_grid_error_um = options.field_grid->interpolation_error_um();
  }
  warn_of_reach(trajectory, trajectory.warnings);
  warn_of_absent_limits(head, trajectory.warnings);
  return trajectory;
}

}  // namespace gravure::scan
