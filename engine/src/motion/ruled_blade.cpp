#include "gravure/motion/ruled_blade.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "check_request.hpp"

namespace gravure::motion {
namespace {

Vector3 blend(const Vector3& a, double s, const Vector3& b, double t) noexcept {
  return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}

Vector3 cross(const Vector3& a, const Vector3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector3& a, const Vector3& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

Vector3 RuledBlade::middle(double u, double v) const {
  return blend(shroud.at(u), 1 - v, hub.at(u), v);
}

Vector3 RuledBlade::side(double u, double v, int which) const {
  const Vector3 along = blend(shroud.slope(u), 1 - v, hub.slope(u), v);
  const Vector3 across = blend(hub.at(u), 1, shroud.at(u), -1);
  const Vector3 normal = cross(along, across);
  const double length = std::sqrt(dot(normal, normal));
  return length > 0 ? blend(middle(u, v), 1, normal, which * thickness_mm / 2 / length) : middle(u, v);
}

Vector3 RuledBlade::hub_surface(double u, double angle_rad) const {
  const Vector3 foot = hub.at(u);
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * foot[0] - s * foot[1], s * foot[0] + c * foot[1], foot[2]};
}

std::vector<Vector3> sample_sides(const RuledBlade& blade, double u_from, double u_to, std::size_t along,
                                  std::size_t across) {
  std::vector<Vector3> points;
  points.reserve(2 * along * across);
  const auto share = [](std::size_t i, std::size_t count) {
    return count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.5;
  };
  for (std::size_t i = 0; i < along; ++i) {
    for (std::size_t j = 0; j < across; ++j) {
      const double u = u_from + (u_to - u_from) * share(i, along);
      points.push_back(blade.side(u, share(j, across), 1));
      points.push_back(blade.side(u, share(j, across), -1));
    }
  }
  return points;
}

Interference find_interference(const ToolPose& tool, const ToolShape& shape, std::span<const Vector3> points,
                               double margin_mm) {
  const double length = std::sqrt(dot(tool.axis, tool.axis));
  Interference worst;
  worst.depth_mm = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 off = blend(points[i], 1, tool.centre_mm, -1);
    const double height = dot(off, tool.axis) / length;
    if (height < shape.clear_from_mm || height > shape.length_mm) {
      continue;
    }
    const Vector3 turned = cross(off, tool.axis);
    const double distance = std::sqrt(dot(turned, turned)) / length;
    const double depth = shape.radius_mm + shape.widening * height + margin_mm - distance;
    if (depth > worst.depth_mm) {
      worst = {depth > 0, depth, i, height, 0};
    }
  }
  return worst;
}

Interference find_interference(std::span<const ToolPose> places, const ToolShape& shape,
                               std::span<const Vector3> points, double margin_mm) {
  Interference worst;
  worst.depth_mm = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Interference found = find_interference(places[i], shape, points, margin_mm);
    if (found.depth_mm > worst.depth_mm) {
      worst = found;
      worst.place = i;
    }
  }
  return worst;
}

Result<Cleared> turn_clear(std::span<const ToolPose> places, const ToolShape& shape, std::span<const Vector3> points,
                           double margin_mm, double ball_radius_mm, double c_step_rad, double c_most_rad,
                           TurnFirst first) {
  GRAVURE_CHECK(check_range("places of the tool", static_cast<double>(places.size()), 1, 1e9));
  GRAVURE_CHECK(check_range("c_step_rad", c_step_rad, 1e-9, 7));
  GRAVURE_CHECK(check_range("c_most_rad", c_most_rad, 0, 1e4 * c_step_rad));
  const Vector3& axis = places.front().axis;
  const double a = std::atan2(std::hypot(axis[0], axis[1]), axis[2]);
  const double c = std::atan2(axis[0], axis[1]);
  std::vector<ToolPose> moved(places.begin(), places.end());
  double least_depth = std::numeric_limits<double>::infinity();
  for (int step = 0; step * c_step_rad <= c_most_rad * (1 + 1e-12); ++step) {
    for (const double side : {static_cast<double>(first), -static_cast<double>(first)}) {
      const double turned = side * step * c_step_rad;
      for (std::size_t i = 0; i < places.size() && step > 0; ++i) {
        moved[i] = tilted(places[i], ball_radius_mm, a, c + turned);
      }
      const Interference found = find_interference(moved, shape, points, margin_mm);
      if (!found.touches) {
        return Cleared{c + turned, turned};
      }
      least_depth = std::min(least_depth, found.depth_mm);
    }
  }
  return Error{
      ErrorCode::out_of_range,
      fmt::format("interference: no turn of c up to {:.6g} degrees clears the blades: {:.6g} mm too deep at best; take "
                  "a slimmer tool or beam, or another tilt",
                  c_most_rad * 180 / 3.14159265358979323846, least_depth)};
}

}  // namespace gravure::motion
