#include "zone_travel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace gravure::zones {
namespace {

/// Of all directions the one nearest to `pole` that is within the limit of each piece.
///
/// It stands on the edges of one or two circles: those of pieces farthest from the answer so far join, one at a time.
std::optional<Vector3> nearest_allowed(const std::vector<Piece>& pieces, const std::vector<std::size_t>& which,
                                       double limit, const Vector3& pole) {
  constexpr int kTravelRounds = 64;
  std::vector<Vector3> standing_on;
  std::optional<Vector3> best = pole;
  for (int round = 0; best && round < kTravelRounds; ++round) {
    const std::size_t farthest = *std::max_element(which.begin(), which.end(), [&](std::size_t a, std::size_t b) {
      return angle_between(*best, pieces[a].direction) < angle_between(*best, pieces[b].direction);
    });
    const Vector3& joining = pieces[farthest].direction;
    if (angle_between(*best, joining) <= limit + kAngleSlack) {
      return best;
    }
    standing_on.push_back(joining);
    std::vector<Vector3> edges;
    for (auto a = standing_on.begin(); a != standing_on.end(); ++a) {
      edges.push_back(std::cos(limit) * *a + std::sin(limit) * (pole - pole.dot(*a) * *a).normalized());
      for (auto b = standing_on.begin(); b != a; ++b) {
        const std::vector<Vector3> crossings = axes_through(*a, *b, limit);
        edges.insert(edges.end(), crossings.begin(), crossings.end());
      }
    }
    best.reset();
    for (const Vector3& edge : edges) {
      const bool is_allowed =
          edge.allFinite() && std::all_of(standing_on.begin(), standing_on.end(), [&](const Vector3& direction) {
            return angle_between(edge, direction) <= limit + kAngleSlack;
          });
      if (is_allowed && (!best || edge.dot(pole) > best->dot(pole))) {
        best = edge;
      }
    }
  }
  return std::nullopt;
}

/// The first zone found on the way to `end` that passes, in steps that are halved where it begins to.
std::optional<Zone> first_on_way(const std::vector<Piece>& pieces, const ZoneLimits& limits, const ZoneCheck& check,
                                 const Zone& zone, const Vector3& end) {
  const auto seen_at = [&](double share) -> std::optional<Zone> {
    const Vector3 direction = ((1 - share) * zone.direction + share * end).normalized();
    Zone seen = describe_zone(pieces, zone.pieces, direction);
    return is_within(seen, limits) && check(seen) ? std::optional<Zone>(std::move(seen)) : std::nullopt;
  };
  constexpr int kSteps = 32;
  constexpr int kHalvings = 10;
  for (int step = 1; step <= kSteps; ++step) {
    std::optional<Zone> found = seen_at(1.0 * step / kSteps);
    if (!found) {
      continue;
    }
    double too_near = 1.0 * (step - 1) / kSteps;
    double far_enough = 1.0 * step / kSteps;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (too_near + far_enough) / 2;
      std::optional<Zone> nearer = seen_at(middle);
      (nearer ? far_enough : too_near) = middle;
      if (nearer) {
        found = std::move(nearer);
      }
    }
    return found;
  }
  return std::nullopt;
}

std::optional<Zone> within_travel(const std::vector<Piece>& pieces, const ZoneLimits& limits,
                                  const kinematics::Machine& machine, const ZoneCheck& check, const Zone& zone) {
  const kinematics::JointPositions zero(machine.joints.size(), 0);
  const Vector3 beam = kinematics::forward(machine, zero, {}).towards_head;
  std::optional<Zone> best;
  for (const Vector3& pole : {beam, Vector3(-beam)}) {
    const std::optional<Vector3> end = nearest_allowed(pieces, zone.pieces, limits.incidence_rad, pole);
    std::optional<Zone> found = end ? first_on_way(pieces, limits, check, zone, *end) : std::nullopt;
    if (found &&
        (!best || angle_between(zone.direction, found->direction) < angle_between(zone.direction, best->direction))) {
      best = std::move(found);
    }
  }
  return best;
}

}  // namespace

Result<void> turn_within_travel(const std::vector<Contour>& contours, const std::vector<Piece>& pieces,
                                const ZoneLimits& limits, const kinematics::Machine& machine, const ZoneCheck& check,
                                Zone& zone) {
  Result<void> reached = check(zone);
  if (reached) {
    return {};
  }
  if (std::optional<Zone> turned = within_travel(pieces, limits, machine, check, zone)) {
    zone = *std::move(turned);
    return {};
  }
  std::size_t named = zone.pieces[0];  // of contours that can be reached one by one alone, the first
  for (const std::size_t i : zone.pieces) {
    const Zone alone = describe_zone(pieces, {i}, pieces[i].direction);
    const Result<void> alone_reached = check(alone);
    if (!alone_reached && !within_travel(pieces, limits, machine, check, alone)) {
      named = i;
      reached = alone_reached;
      break;
    }
  }
  return Error{
      reached.error().code,
      fmt::format("contour {}: {}: no direction found within {:.6g} deg of its zone's contours is within travel: "
                  "allow more incidence, clamp the part another way and move its contours with it, or take a "
                  "machine of more travel",
                  contours[pieces[named].contour].id, reached.error().message,
                  limits.incidence_rad * 180 / std::numbers::pi)};
}

}  // namespace gravure::zones
