#include "zone_of.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace gravure::zones {
namespace {

std::vector<Vector3> directions_of(const std::vector<Piece>& pieces, const std::vector<std::size_t>& which) {
  std::vector<Vector3> directions;
  directions.reserve(which.size());
  for (const std::size_t i : which) {
    directions.push_back(pieces[i].direction);
  }
  return directions;
}

/// Length of a step seen along any direction within `limit` of `direction`, at least.
double least_seen(const Vector3& step, const Vector3& direction, double limit) noexcept {
  const double angle = angle_between(step, direction);
  const double slanting = std::min(angle, std::numbers::pi - angle);
  return step.norm() * std::sin(std::max(0.0, slanting - limit));
}

}  // namespace

void Extent::add(const Extent& other) noexcept {
  least = least.cwiseMin(other.least);
  most = most.cwiseMax(other.most);
}

Extent extent_of(const Piece& piece, const LocalFrame& frame) noexcept {
  const Vector3 first = frame.to_local(piece.points_mm[0]);
  Extent extent{first, first};
  for (const Vector3& point : piece.points_mm) {
    const Vector3 local = frame.to_local(point);
    extent.add({local, local});
  }
  return extent;
}

Extent extent_of(const std::vector<Piece>& pieces, const std::vector<std::size_t>& which, const LocalFrame& frame) {
  Extent extent = extent_of(pieces[which[0]], frame);
  for (const std::size_t i : which) {
    extent.add(extent_of(pieces[i], frame));
  }
  return extent;
}

std::vector<Vector3> axes_through(const Vector3& a, const Vector3& b, double angle) {
  const Vector3 middle = (a + b).normalized();
  const Vector3 side = a.cross(b).normalized();
  // cos(angle) = cos(half) cos(lift): the axis is lifted out of the plane of both.
  const double cosine = std::cos(angle) / middle.dot(a);
  if (!(cosine <= 1) || !side.allFinite() || !middle.allFinite()) {
    return {};
  }
  const double sine = std::sqrt(1 - cosine * cosine);
  return {cosine * middle + sine * side, cosine * middle - sine * side};
}

LocalFrame frame_of(const Vector3& direction) {
  return local_frame(direction, Vector3::Zero()).value();
}

Zone describe_zone(const std::vector<Piece>& pieces, std::vector<std::size_t> which, const Vector3& direction) {
  const std::vector<Vector3> directions = directions_of(pieces, which);
  const Extent extent = extent_of(pieces, which, frame_of(direction));
  Zone zone;
  zone.direction = direction;
  zone.max_incidence_rad = largest_angle_from(direction, directions);
  zone.width_mm = extent.most.x() - extent.least.x();
  zone.height_mm = extent.most.y() - extent.least.y();
  zone.pieces = std::move(which);
  return zone;
}

bool is_within(const Zone& zone, const ZoneLimits& limits) noexcept {
  return zone.max_incidence_rad <= limits.incidence_rad + kAngleSlack &&
         std::max(zone.width_mm, zone.height_mm) <= limits.field_mm + kFieldSlackMm;
}

std::optional<Zone> zone_of(const std::vector<Piece>& pieces, const std::vector<std::size_t>& which,
                            const ZoneLimits& limits, const Vector3& other) {
  const Result<Cone> cone = enclosing_cone(directions_of(pieces, which));
  if (!cone || cone.value().half_angle_rad > limits.incidence_rad + kAngleSlack) {
    return std::nullopt;
  }
  for (const Vector3& direction : {cone.value().axis, other}) {
    Zone zone = describe_zone(pieces, which, direction);
    if (is_within(zone, limits)) {
      return zone;
    }
  }
  return std::nullopt;
}

Result<void> check_limits(const std::vector<Piece>& pieces, const ZoneLimits& limits) {
  if (!(limits.incidence_rad > 0) || !(limits.incidence_rad < std::numbers::pi / 2)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("incidence limit = {} rad: must be above 0 and below pi/2", limits.incidence_rad)};
  }
  if (!(limits.field_mm > 0)) {
    return Error{ErrorCode::out_of_range, fmt::format("field_mm = {}: must be greater than 0", limits.field_mm)};
  }
  if (pieces.empty()) {
    return Error{ErrorCode::bad_argument, "no contour to make zones of"};
  }
  return {};
}

void sort_zones(std::vector<Zone>& zones) {
  for (Zone& zone : zones) {
    std::sort(zone.pieces.begin(), zone.pieces.end());
  }
  std::sort(zones.begin(), zones.end(), [](const Zone& a, const Zone& b) { return a.pieces[0] < b.pieces[0]; });
}

void measure_zones(const std::vector<Piece>& pieces, std::vector<Zone>& zones) {
  for (Zone& zone : zones) {
    const std::vector<Vector3> directions = directions_of(pieces, zone.pieces);
    const Result<Cone> cone = enclosing_cone(directions);
    zone.cone_rad = cone ? cone.value().half_angle_rad : std::numbers::pi / 2;
    zone.max_pairwise_rad = largest_angle(directions);
  }
}

bool are_apart(const Piece& a, const Piece& b, const ZoneLimits& limits) {
  const double limit = limits.incidence_rad + kAngleSlack;
  if (angle_between(a.direction, b.direction) > 2 * limit) {
    return true;
  }
  const double diagonal = (limits.field_mm + kFieldSlackMm) * std::numbers::sqrt2;
  for (const Vector3& p : {a.points_mm.front(), a.points_mm[a.points_mm.size() / 2], a.points_mm.back()}) {
    for (const Vector3& q : {b.points_mm.front(), b.points_mm[b.points_mm.size() / 2], b.points_mm.back()}) {
      const Vector3 step = q - p;
      if (std::max(least_seen(step, a.direction, limit), least_seen(step, b.direction, limit)) > diagonal) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace gravure::zones
