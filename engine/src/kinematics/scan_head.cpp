#include "gravure/kinematics/scan_head.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gravure::kinematics {
namespace {

constexpr double kQuarterTurn = 1.57079632679489661923;
constexpr int kMostHeadSteps = 50;

double tilt_of(const ScanHead& head) noexcept {
  return head.lens == Lens::f_theta ? head.tilt_rad_per_mm : 0;
}

/// r with r - height * tan(tilt * r) = distance: where the beam through a point so far from the axis and so far from
/// the focal plane leaves the lens. NaN where there is none.
double field_radius(double distance, double height, double tilt) noexcept {
  double r = distance;
  for (int step = 0; step < kMostHeadSteps; ++step) {
    if (!(std::abs(tilt * r) < kQuarterTurn)) {
      break;
    }
    const double slope = std::tan(tilt * r);
    const double derivative = 1 - height * tilt * (1 + slope * slope);
    if (!(derivative > 0)) {
      break;  // beyond where neighbouring beams cross
    }
    const double change = (r - height * slope - distance) / derivative;
    r -= change;
    if (std::abs(change) <= 1e-15 * (std::abs(r) + std::abs(distance))) {
      return r;
    }
  }
  return std::abs(r - height * std::tan(tilt * r) - distance) <= 1e-13 * (1 + distance) ? r : std::nan("");
}

}  // namespace

Vector3 beam_of(const ScanHead& head, const FieldPoint& field) {
  const double tilt = tilt_of(head);
  const double r = std::hypot(field.u_mm, field.v_mm);
  if (tilt == 0 || r == 0) {
    return Vector3::UnitZ();
  }
  const double inward = -std::sin(tilt * r) / r;
  return {inward * field.u_mm, inward * field.v_mm, std::cos(tilt * r)};
}

Result<FieldPoint> field_of_point(const ScanHead& head, const Vector3& point_mm) {
  const double tilt = tilt_of(head);
  const double distance = std::hypot(point_mm.x(), point_mm.y());
  if (tilt == 0 || distance == 0) {
    return FieldPoint{point_mm.x(), point_mm.y(), point_mm.z()};
  }
  const double r = field_radius(distance, point_mm.z(), tilt);
  if (std::isnan(r)) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("kinematics: no beam of the f-theta lens (tilt {:.6g} rad/mm) passes a point {:.6g} mm from the "
                    "lens axis and {:.6g} mm from the focal plane",
                    tilt, distance, point_mm.z())};
  }
  return FieldPoint{point_mm.x() * r / distance, point_mm.y() * r / distance, point_mm.z() / std::cos(tilt * r)};
}

Result<void> check_field(const ScanHead& head, const FieldPoint& field) {
  const double reach = std::max(std::abs(field.u_mm), std::abs(field.v_mm));
  if (reach <= head.field_mm / 2) {
    return {};
  }
  return Error{ErrorCode::out_of_range,
               fmt::format("kinematics: U = {:.6g} mm, V = {:.6g} mm: outside the scanner's field_mm = {:.6g} (-{:.6g} "
                           "to {:.6g}); a field "
                           "of {:.6g} mm would do",
                           field.u_mm, field.v_mm, head.field_mm, head.field_mm / 2, head.field_mm / 2, 2 * reach)};
}

}  // namespace gravure::kinematics
