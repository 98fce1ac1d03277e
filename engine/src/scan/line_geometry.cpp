#include "gravure/scan/line_geometry.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "gravure/kinematics/machines.hpp"

namespace gravure::scan {
namespace {

Result<void> check_positive(const char* field, double value) {
  if (value > 0 && value <= 1e6) {
    return {};
  }
  return Error{ErrorCode::out_of_range,
               fmt::format("scan: {} = {}: must be above 0 and at most 1000000", field, value)};
}

}  // namespace

CylinderLines cylinder_lines(const Plan& plan, double offset_deg) {
  return {to_double(plan.rotary.circumference_um) / 1000 / std::numbers::pi, plan.rotary.lines_per_revolution,
          to_double(plan.line.pixel_pitch_um) / 1000, offset_deg, 0};
}

Result<LineGeometry> cylinder_geometry(const LineTiming& timing, const CylinderLines& lines,
                                       const kinematics::ScanHead& head) {
  GRAVURE_CHECK(check_timing(timing));
  GRAVURE_CHECK(check_positive("diameter_mm", lines.diameter_mm));
  GRAVURE_CHECK(check_positive("pixel_pitch_mm", lines.pixel_pitch_mm));
  if (lines.lines_per_revolution < 1) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("scan: lines_per_revolution = {}: must be 1 or more", lines.lines_per_revolution)};
  }
  if (!(std::abs(lines.carriage_mm_per_line) <= 1e3)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("scan: carriage_mm_per_line = {}: must be -1000 to 1000", lines.carriage_mm_per_line)};
  }
  if (!(std::abs(lines.offset_deg) <= kMostIncidenceDeg)) {
    return Error{ErrorCode::out_of_range, fmt::format("scan: offset_deg = {}: must be {} to {}", lines.offset_deg,
                                                      -kMostIncidenceDeg, kMostIncidenceDeg)};
  }
  const double radius = lines.diameter_mm / 2;
  const double offset = lines.offset_deg * std::numbers::pi / 180;
  const auto slots = static_cast<double>(timing.slots);
  LineGeometry geometry;
  geometry.machine = kinematics::cylinder_machine(radius * std::cos(offset), head);
  geometry.at_centre = {0, 0, 0};
  geometry.per_slot = {2 * std::numbers::pi / static_cast<double>(lines.lines_per_revolution) / slots,
                       lines.carriage_mm_per_line / slots, 0};
  geometry.pixel_pitch_mm = lines.pixel_pitch_mm;
  geometry.centre_v_mm = radius * std::sin(offset);
  geometry.surface_normal = {0, std::sin(offset), std::cos(offset)};
  return geometry;
}

Result<LineGeometry> plane_geometry(const LineTiming& timing, const PlaneLines& lines,
                                    const kinematics::ScanHead& head) {
  GRAVURE_CHECK(check_timing(timing));
  GRAVURE_CHECK(check_positive("line_pitch_mm", lines.line_pitch_mm));
  GRAVURE_CHECK(check_positive("pixel_pitch_mm", lines.pixel_pitch_mm));
  LineGeometry geometry;
  geometry.machine = kinematics::plane_machine(head);
  geometry.at_centre = {0, 0, 0};
  geometry.per_slot = {0, lines.line_pitch_mm / static_cast<double>(timing.slots), 0};
  geometry.pixel_pitch_mm = lines.pixel_pitch_mm;
  return geometry;
}

}  // namespace gravure::scan
