#include "gravure/scan/landing.hpp"

#include <cmath>

#include "gravure/core/units.hpp"
#include "set_point_at.hpp"

namespace gravure::scan {
namespace {

using kinematics::FieldPoint;
using kinematics::Vector3;

}  // namespace

LandingModel landing_model(const LineTrajectory& trajectory) {
  return {to_double(trajectory.path.geometry().machine.head.lag_us), true, true};
}

FieldPoint mirrors_at(const LineTrajectory& trajectory, Direction direction, double slot, const LandingModel& model) {
  const LineTiming& timing = trajectory.path.timing();
  const double followed = slot - model.lag_us * 1e-6 / timing.slot_s();
  if (!model.microvectors) {
    const double early = static_cast<double>(trajectory.lag_ticks) / static_cast<double>(timing.ticks_per_slot);
    const FieldPoint wanted = trajectory.path.at(direction, followed + early);
    return model.rounding ? rounded(wanted, trajectory.resolution_mm) : FieldPoint{wanted.u_mm, wanted.v_mm, 0};
  }
  const auto slots = static_cast<double>(timing.slots);
  const double lines = std::floor(followed / slots);
  const auto turned = [&timing](Direction d) {
    return timing.bidirectional && d == Direction::forward ? Direction::reverse : Direction::forward;
  };
  const Direction here = std::fmod(lines, 2) == 0 ? direction : turned(direction);
  const std::vector<SetPoint>& points = trajectory.set_points(here);
  const double microvectors = (followed - lines * slots) / static_cast<double>(timing.slots_per_microvector);
  const std::size_t index = std::min(static_cast<std::size_t>(microvectors), points.size() - 1);
  const SetPoint& next = index + 1 < points.size() ? points[index + 1] : trajectory.set_points(turned(here)).front();
  return between(trajectory, points[index], next, microvectors - static_cast<double>(index), model.rounding);
}

LandingError landing_error(const LineTrajectory& trajectory, Direction direction, std::int64_t pixel,
                           const LandingModel& model) {
  const LinePath& path = trajectory.path;
  const LineGeometry& geometry = path.geometry();
  const double slot = path.timing().pulse_at(direction, path.timing().slot_of_pixel(direction, pixel));
  const Vector3 target = path.target(static_cast<double>(pixel));
  const Vector3 along = (path.target(static_cast<double>(pixel) + 1) - target).normalized();
  const Vector3& normal = geometry.surface_normal;
  const Vector3 across(normal.y() * along.z() - normal.z() * along.y(), normal.z() * along.x() - normal.x() * along.z(),
                       normal.x() * along.y() - normal.y() * along.x());
  const FieldPoint mirrors = mirrors_at(trajectory, direction, slot, model);
  const auto spot = kinematics::forward(geometry.machine, path.joints_at(slot), mirrors);
  // Along the beam to the surface, which is its tangent plane at so small a distance.
  const double towards_head = (target - spot.position_mm).dot(normal) / spot.towards_head.dot(normal);
  const Vector3 missed = spot.position_mm + towards_head * spot.towards_head - target;
  return {missed.dot(along) * kUmPerMm, missed.dot(across) * kUmPerMm, towards_head * kUmPerMm};
}

std::vector<LandingError> landing_errors(const LineTrajectory& trajectory, Direction direction,
                                         const LandingModel& model) {
  std::vector<LandingError> errors;
  errors.reserve(static_cast<std::size_t>(trajectory.path.timing().pixels));
  for (std::int64_t pixel = 0; pixel < trajectory.path.timing().pixels; ++pixel) {
    errors.push_back(landing_error(trajectory, direction, pixel, model));
  }
  return errors;
}

}  // namespace gravure::scan
