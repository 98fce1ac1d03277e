#include "zone_travel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

/// Of two pieces or more those nearer to one, and to the other, of two that are far apart: in direction, or in place
/// where their directions are the same.
std::array<std::vector<std::size_t>, 2> halves_of(const std::vector<Piece>& pieces,
                                                  const std::vector<std::size_t>& which) {
  const auto by_direction = [&pieces](std::size_t a, std::size_t b) {
    return (pieces[a].direction - pieces[b].direction).norm();
  };
  const auto by_place = [&pieces](std::size_t a, std::size_t b) {
    return (pieces[a].points_mm[0] - pieces[b].points_mm[0]).norm();
  };
  std::array<std::vector<std::size_t>, 2> halves;
  const auto part_by = [&](const auto& way) {
    const auto farthest_from = [&](std::size_t piece) {
      return *std::max_element(which.begin(), which.end(),
                               [&](std::size_t a, std::size_t b) { return way(piece, a) < way(piece, b); });
    };
    const std::size_t one = farthest_from(which[0]);
    const std::size_t other = farthest_from(one);
    halves = {};
    for (const std::size_t i : which) {
      halves[way(one, i) <= way(other, i) ? 0 : 1].push_back(i);
    }
    return !halves[1].empty();
  };
  if (!part_by(by_direction) && !part_by(by_place)) {  // the same line twice
    const auto middle = which.begin() + static_cast<std::ptrdiff_t>(which.size() / 2);
    halves = {std::vector<std::size_t>(which.begin(), middle), std::vector<std::size_t>(middle, which.end())};
  }
  return halves;
}

}  // namespace

Result<std::vector<Zone>> zones_within_travel(const std::vector<Contour>& contours, const std::vector<Piece>& pieces,
                                              const ZoneLimits& limits, const kinematics::Machine& machine,
                                              const ZoneCheck& check, const Zone& zone) {
  const Result<void> reached = check(zone);
  if (reached) {
    return std::vector<Zone>{zone};
  }
  if (std::optional<Zone> turned = within_travel(pieces, limits, machine, check, zone)) {
    turned->cone_rad = zone.cone_rad;  // of the same pieces
    turned->max_pairwise_rad = zone.max_pairwise_rad;
    return std::vector<Zone>{*std::move(turned)};
  }
  if (zone.pieces.size() == 1) {
    return Error{
        reached.error().code,
        fmt::format("contour {}: {}: no direction found within {:.6g} deg of its own is within travel: allow more "
                    "incidence, clamp the part another way and move its contours with it, or take a machine of more "
                    "travel",
                    contours[pieces[zone.pieces[0]].contour].id, reached.error().message,
                    limits.incidence_rad * 180 / std::numbers::pi)};
  }
  std::vector<Zone> all;
  for (const std::vector<std::size_t>& half : halves_of(pieces, zone.pieces)) {
    // What the whole zone has in its field and its limits, each half has from the same direction.
    std::vector<Zone> part{
        zone_of(pieces, half, limits, zone.direction).value_or(describe_zone(pieces, half, zone.direction))};
    measure_zones(pieces, part);
    GRAVURE_TRY(const std::vector<Zone> found,
                zones_within_travel(contours, pieces, limits, machine, check, part.front()));
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

}  // namespace gravure::zones
