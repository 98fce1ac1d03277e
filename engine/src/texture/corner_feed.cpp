#include "corner_feed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gravure/texture/corner_law.hpp"

namespace gravure::texture {
namespace {

constexpr double kStraight = 3;  ///< sigma: an infinite path is no other there
constexpr double kLeastTurn = 1e-6;

/// A corner and the straight lines before and behind it.
struct Corner {
  std::size_t point = 0;
  std::size_t reach = 0;  ///< points to both sides that are straight
  double step_mm = 0;
  double turn_rad = 0;
  Vector3 bend = Vector3::Zero();  ///< of length 1: where the turn goes, in the plane
};

Corner corner_at(const PathTimingRequest& request, std::size_t before, std::size_t point, std::size_t after) {
  const auto at = [&request](std::size_t i) { return Vector2(request.targets[i].position_mm.head<2>()); };
  const Vector2 in = (at(point) - at(before)).normalized();
  const Vector2 out = (at(after) - at(point)).normalized();
  Corner corner;
  corner.point = point;
  corner.reach = std::min(point - before, after - point);
  corner.step_mm = (at(point) - at(point - 1)).norm();
  corner.turn_rad = std::atan2(std::abs(in.x() * out.y() - in.y() * out.x()), in.dot(out));
  const Vector2 bend = (out - in).normalized();
  corner.bend = {bend.x(), bend.y(), 0};
  return corner;
}

/// Points a second at the corner itself: each stage has its part of the bend.
double law_speed(const PathTimingRequest& request, const Corner& corner) {
  const SevenAxes& pose = request.axes[corner.point];
  const Vector3 part = request.table.turned(pose.a_rad, pose.c_rad, corner.bend + request.table.centre_mm);
  double speed_mm_s = std::numeric_limits<double>::infinity();
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    constexpr double kNone = 1e-9;
    const double share = std::max(std::abs(part[axis]), kNone);
    const AxisBounds& limits = request.limits[static_cast<std::size_t>(axis)];
    speed_mm_s = std::min(speed_mm_s, corner_speed_mm_s(corner.turn_rad, request.sigma_points * corner.step_mm,
                                                        limits.acceleration / share, limits.jerk / share));
  }
  return speed_mm_s / corner.step_mm;
}

}  // namespace

std::vector<double> corner_feed(const PathTimingRequest& request) {
  std::vector<double> feed;
  if (!(request.sigma_points > 0)) {
    return feed;
  }
  const std::vector<std::size_t> rests = resting_points(request.targets, Stops::corners);
  for (std::size_t k = 1; k + 1 < rests.size(); ++k) {
    const Corner corner = corner_at(request, rests[k - 1], rests[k], rests[k + 1]);
    if (!(corner.turn_rad > kLeastTurn) || static_cast<double>(corner.reach) < kStraight * request.sigma_points) {
      continue;
    }
    feed.resize(request.targets.size(), std::numeric_limits<double>::infinity());
    const double speed = law_speed(request, corner);
    for (std::size_t i = corner.point - corner.reach; i <= corner.point + corner.reach; ++i) {
      const double away = (static_cast<double>(i) - static_cast<double>(corner.point)) / request.sigma_points;
      feed[i] = std::min(feed[i], speed * std::exp(away * away / 4));
    }
  }
  return feed;
}

}  // namespace gravure::texture
