#include "gravure/zones/cover.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "set_cover.hpp"
#include "zone_of.hpp"

namespace gravure::zones {
namespace {

/// With more directions, circles through pairs of a sample of them alone are looked at.
constexpr std::size_t kMostDirections = 150;
constexpr std::size_t kMostWindowEdges = 64;
/// With more pieces, a sample of them alone bounds the number of zones: what no fewer zones hold of it, no fewer hold
/// of all.
constexpr std::size_t kMostBounded = 1500;

/// So many sets of so many pieces are compared with each other in some seconds.
std::size_t most_sets(std::size_t pieces) {
  constexpr double kSteps = 2.5e12;  // pairs times pieces
  return static_cast<std::size_t>(std::sqrt(kSteps / static_cast<double>(pieces)));
}

/// Circles through pairs of directions, two of each, are at most most_sets().
std::size_t most_directions(std::size_t pieces) {
  return std::min(kMostDirections, static_cast<std::size_t>(std::sqrt(static_cast<double>(most_sets(pieces)))));
}

/// Left and lower edges of windows for each of `sets` that do not fit the field.
std::size_t most_edges(std::size_t pieces, std::size_t sets) {
  const auto edges = std::sqrt(static_cast<double>(most_sets(pieces)) / static_cast<double>(sets));
  return std::clamp<std::size_t>(static_cast<std::size_t>(edges), 2, kMostWindowEdges);
}

/// Pieces that share a direction from which all of them can be marked.
struct Candidates {
  std::vector<Bits> sets;
  std::vector<Vector3> axes;
  bool is_complete = true;  ///< every set that any direction has is part of one of these

  void keep_maximal(const ZoneWatch& watch) {
    const std::vector<std::size_t> kept = maximal_sets(sets, watch);
    Candidates rest;
    for (const std::size_t s : kept) {
      rest.sets.push_back(sets[s]);
      rest.axes.push_back(axes[s]);
    }
    rest.is_complete = is_complete;
    *this = std::move(rest);
  }
};

/// The different directions; where there are too many, ones far from each other.
std::vector<Vector3> sample_directions(const std::vector<Piece>& pieces, bool& is_complete) {
  std::vector<Vector3> all;
  all.reserve(pieces.size());
  for (const Piece& piece : pieces) {
    all.push_back(piece.direction);
  }
  const auto less = [](const Vector3& a, const Vector3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::sort(all.begin(), all.end(), less);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  const std::size_t most = most_directions(pieces.size());
  is_complete = all.size() <= most;
  if (is_complete) {
    return all;
  }
  std::vector<Vector3> sample{all[0]};
  std::vector<double> cosine(all.size(), -2);
  while (sample.size() < most) {
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      cosine[i] = std::max(cosine[i], all[i].dot(sample.back()));
      farthest = cosine[i] < cosine[farthest] ? i : farthest;
    }
    sample.push_back(all[farthest]);
  }
  return sample;
}

/// Every largest set of pieces within the limit of one direction, whatever their place.
Candidates candidates_by_direction(const std::vector<Piece>& pieces, double limit, const ZoneWatch& watch) {
  Candidates found;
  const std::vector<Vector3> sample = sample_directions(pieces, found.is_complete);
  std::map<Bits, Vector3> sets;
  const auto offer = [&](const Vector3& axis) {
    Bits members(pieces.size());
    // A direction beyond the limit by rounding alone counts: it may be one of the two that the circle goes through.
    const double least = std::cos(limit + kAngleSlack);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (pieces[i].direction.dot(axis) >= least) {
        members.set(i);
      }
    }
    if (!members.empty()) {
      sets.emplace(std::move(members), axis);
    }
  };
  for (std::size_t i = 0; i < sample.size() && !watch.stopped(); ++i) {
    watch.tell(ZonePart::candidates, i, sample.size());
    offer(sample[i]);
    for (std::size_t j = i + 1; j < sample.size(); ++j) {
      for (const Vector3& axis : axes_through(sample[i], sample[j], limit)) {
        offer(axis);
      }
    }
  }
  if (!found.is_complete) {  // directions outside the sample need a set as well
    for (std::size_t i = 0; i < pieces.size() && !watch.stopped(); ++i) {
      offer(pieces[i].direction);
    }
  }
  for (auto& [members, axis] : sets) {
    found.sets.push_back(members);
    found.axes.push_back(axis);
  }
  found.keep_maximal(watch);
  return found;
}

/// Numbers of a list, about `most` of them.
std::vector<double> edges_of(std::vector<double> values, std::size_t most) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  const std::size_t step = (values.size() + most - 1) / most;
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); i += step) {
    kept.push_back(values[i]);
  }
  return kept;
}

/// What of a set a field sees that stands with its left and lower edge at those of pieces.
void add_windows(const std::vector<Piece>& pieces, const std::vector<std::size_t>& members, const Vector3& axis,
                 double field_mm, std::size_t most, Candidates& found) {
  const LocalFrame frame = frame_of(axis);
  std::vector<Extent> boxes;
  std::vector<double> lefts;
  std::vector<double> bottoms;
  for (const std::size_t i : members) {
    boxes.push_back(extent_of(pieces[i], frame));
    lefts.push_back(boxes.back().least.x());
    bottoms.push_back(boxes.back().least.y());
  }
  const double side = field_mm + kFieldSlackMm;
  for (const double left : edges_of(lefts, most)) {
    for (const double bottom : edges_of(bottoms, most)) {
      Bits seen(pieces.size());
      for (std::size_t m = 0; m < members.size(); ++m) {
        const Extent& box = boxes[m];
        if (box.least.x() >= left && box.least.y() >= bottom && box.most.x() <= left + side &&
            box.most.y() <= bottom + side) {
          seen.set(members[m]);
        }
      }
      if (!seen.empty()) {
        found.sets.push_back(std::move(seen));
        found.axes.push_back(axis);
      }
    }
  }
}

/// The same sets as far as they fit the field; each has a direction from which all its pieces can be marked.
Candidates fit_field(const std::vector<Piece>& pieces, const Candidates& by_direction, const ZoneLimits& limits,
                     const ZoneWatch& watch) {
  Candidates found;
  found.is_complete = by_direction.is_complete;
  const std::size_t edges = most_edges(pieces.size(), by_direction.sets.size());
  for (std::size_t s = 0; s < by_direction.sets.size() && !watch.stopped(); ++s) {
    watch.tell(ZonePart::windows, s, by_direction.sets.size());
    const std::vector<std::size_t> members = by_direction.sets[s].members();
    const std::optional<Zone> whole = zone_of(pieces, members, limits, by_direction.axes[s]);
    if (whole) {
      found.sets.push_back(by_direction.sets[s]);
      found.axes.push_back(whole->direction);
    } else {
      found.is_complete = false;
      add_windows(pieces, members, by_direction.axes[s], limits.field_mm, edges, found);
    }
  }
  if (!found.is_complete) {  // each piece alone fits from its own direction
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      Bits alone(pieces.size());
      alone.set(i);
      found.sets.push_back(std::move(alone));
      found.axes.push_back(pieces[i].direction);
    }
  }
  found.keep_maximal(watch);
  return found;
}

/// Each piece to the chosen set that sees it at the least angle.
std::vector<Zone> assign(const std::vector<Piece>& pieces, const Candidates& candidates,
                         const std::vector<std::size_t>& chosen, const ZoneLimits& limits) {
  std::vector<std::vector<std::size_t>> members(chosen.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    std::size_t best = chosen.size();
    double least = 0;
    for (std::size_t c = 0; c < chosen.size(); ++c) {
      const double angle = angle_between(pieces[i].direction, candidates.axes[chosen[c]]);
      if (candidates.sets[chosen[c]].has(i) && (best == chosen.size() || angle < least)) {
        best = c;
        least = angle;
      }
    }
    members[best].push_back(i);
  }
  std::vector<Zone> zones;
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    if (!members[c].empty()) {
      const Vector3& axis = candidates.axes[chosen[c]];
      const std::optional<Zone> zone = zone_of(pieces, members[c], limits, axis);
      zones.push_back(zone ? *zone : describe_zone(pieces, members[c], axis));
    }
  }
  return zones;
}

/// Largest number of pieces found no two of which can share a zone.
std::size_t packing_of(const std::vector<Piece>& pieces, const ZoneLimits& limits, const ZoneWatch& watch) {
  std::vector<Bits> neighbours(pieces.size(), Bits(pieces.size()));
  for (std::size_t i = 0; i < pieces.size() && !watch.stopped(); ++i) {
    watch.tell(ZonePart::bound, i, pieces.size());
    neighbours[i].set(i);
    for (std::size_t j = i + 1; j < pieces.size(); ++j) {
      if (!are_apart(pieces[i], pieces[j], limits)) {
        neighbours[i].set(j);
        neighbours[j].set(i);
      }
    }
  }
  return largest_packing(neighbours);
}

std::size_t bound_of(const std::vector<Piece>& pieces, const ZoneLimits& limits, const Candidates& by_direction,
                     const ZoneWatch& watch) {
  std::vector<Piece> sample;
  for (std::size_t i = 0; pieces.size() > kMostBounded && i < kMostBounded; ++i) {
    sample.push_back(pieces[i * pieces.size() / kMostBounded]);
  }
  std::size_t bound = packing_of(sample.empty() ? pieces : sample, limits, watch);
  if (by_direction.is_complete) {
    const SetCover cover = smallest_cover(by_direction.sets, pieces.size(), watch);
    bound = cover.is_proved ? std::max(bound, cover.chosen.size()) : bound;
  }
  return bound;
}

}  // namespace

Result<std::size_t> lower_bound_of(const std::vector<Piece>& pieces, const ZoneLimits& limits, const ZoneWatch& watch) {
  const Candidates by_direction = candidates_by_direction(pieces, limits.incidence_rad, watch);
  GRAVURE_CHECK(watch.go_on());
  const std::size_t bound = bound_of(pieces, limits, by_direction, watch);
  GRAVURE_CHECK(watch.go_on());
  return bound;
}

Result<ZoneSet> cover_zones(const std::vector<Piece>& pieces, const ZoneLimits& limits, const ZoneWatch& watch) {
  GRAVURE_CHECK(check_limits(pieces, limits));
  const Candidates by_direction = candidates_by_direction(pieces, limits.incidence_rad, watch);
  GRAVURE_CHECK(watch.go_on());
  ZoneSet set;
  set.lower_bound = bound_of(pieces, limits, by_direction, watch);
  GRAVURE_CHECK(watch.go_on());
  const Candidates candidates = fit_field(pieces, by_direction, limits, watch);
  GRAVURE_CHECK(watch.go_on());
  watch.tell(ZonePart::cover, 0, 1);
  const SetCover cover = smallest_cover(candidates.sets, pieces.size(), watch);
  GRAVURE_CHECK(watch.go_on());
  set.zones = assign(pieces, candidates, cover.chosen, limits);
  take_k_means(pieces, limits, watch, set);
  GRAVURE_CHECK(watch.go_on());
  refine_zones(pieces, limits, watch, set.zones);
  GRAVURE_CHECK(watch.go_on());
  sort_zones(set.zones);
  measure_zones(pieces, set.zones);
  return set;
}

}  // namespace gravure::zones
