#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "gravure/zones/k_means.hpp"
#include "zone_of.hpp"

namespace gravure::zones {
namespace {

constexpr std::size_t kDimensions = 6;
constexpr std::size_t kMostClusterLooks = 30'000'000;
constexpr double kDegrees = 180 / std::numbers::pi;

/// Middle of a piece by its length: how densely its points lie plays no part.
Vector3 middle_of(const Piece& piece) {
  Vector3 sum = Vector3::Zero();
  double length = 0;
  for (std::size_t i = 1; i < piece.points_mm.size(); ++i) {
    const double step = (piece.points_mm[i] - piece.points_mm[i - 1]).norm();
    sum += step / 2 * (piece.points_mm[i] + piece.points_mm[i - 1]);
    length += step;
  }
  return length > 0 ? Vector3(sum / length) : piece.points_mm[0];
}

/// x, y, z and u, v, w of each piece.
std::vector<double> features_of(const std::vector<Piece>& pieces, bool normalised) {
  std::vector<Vector3> middles;
  for (const Piece& piece : pieces) {
    middles.push_back(middle_of(piece));
  }
  Vector3 least = middles[0];
  Vector3 most = middles[0];
  for (const Vector3& middle : middles) {
    least = least.cwiseMin(middle);
    most = most.cwiseMax(middle);
  }
  std::vector<double> features;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const double range = most[k] - least[k];
      features.push_back(!normalised ? middles[i][k] : range > 0 ? (middles[i][k] - least[k]) / range : 0);
    }
    features.insert(features.end(), pieces[i].direction.data(), pieces[i].direction.data() + 3);
  }
  return features;
}

/// Seen along the centre of its directions, made of length 1; where they cancel, along the first of them.
Zone published_zone(const std::vector<Piece>& pieces, const std::vector<std::size_t>& members) {
  Vector3 sum = Vector3::Zero();
  for (const std::size_t i : members) {
    sum += pieces[i].direction;
  }
  constexpr double kCancelled = 1e-9;
  const double length = sum.norm();
  return describe_zone(pieces, members, length > kCancelled ? Vector3(sum / length) : pieces[members[0]].direction);
}

Result<ZoneSet> cluster(const std::vector<Piece>& pieces, const std::vector<double>& features, std::size_t clusters,
                        std::uint64_t seed, const ZoneWatch& watch) {
  KMeansRequest request;
  request.clusters = clusters;
  request.dimensions = kDimensions;
  request.seed = seed;
  request.cancel = watch.cancel;
  GRAVURE_TRY(const Clustering found, k_means(features, request));
  ZoneSet set;
  set.clusters = clusters;
  set.inertia = found.inertia;
  std::vector<std::vector<std::size_t>> members(found.clusters(kDimensions));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    members[found.labels[i]].push_back(i);
  }
  for (const std::vector<std::size_t>& of_zone : members) {
    set.zones.push_back(published_zone(pieces, of_zone));
  }
  sort_zones(set.zones);
  return set;
}

void add_violations(const ZoneLimits& limits, ZoneSet& set) {
  for (std::size_t z = 0; z < set.zones.size(); ++z) {
    const Zone& zone = set.zones[z];
    if (zone.max_incidence_rad > limits.incidence_rad + kAngleSlack) {
      set.violations.push_back(fmt::format("zone {}: incidence {:.3f} deg, allowed {:.3f}", z,
                                           zone.max_incidence_rad * kDegrees, limits.incidence_rad * kDegrees));
    }
    if (std::max(zone.width_mm, zone.height_mm) > limits.field_mm + kFieldSlackMm) {
      set.violations.push_back(fmt::format("zone {}: {:.3f} x {:.3f} mm in a field of {:.3f} mm", z, zone.width_mm,
                                           zone.height_mm, limits.field_mm));
    }
  }
}

/// The fewest clusters from `first` to `last` that meet the limits; where none do, `last` clusters and their
/// violations.
Result<ZoneSet> fewest_clusters(const std::vector<Piece>& pieces, const ZoneLimits& limits, std::size_t first,
                                std::size_t last, const KMeansZones& options, const ZoneWatch& watch) {
  const std::vector<double> features = features_of(pieces, options.normalised);
  std::size_t looks = 0;  // at a piece from a centre, as far as that is known beforehand
  for (std::size_t clusters = first;; ++clusters) {
    looks += clusters * pieces.size();
    if (first < last && looks > kMostClusterLooks) {
      return Error{ErrorCode::out_of_range,
                   fmt::format("k: up to {} clusters of {} contours and parts of them do not meet the limits, and more "
                               "are not tried: give k, or wider limits",
                               clusters - 1, pieces.size())};
    }
    GRAVURE_CHECK(watch.go_on());
    watch.tell(ZonePart::k_means, clusters - first, last - first + 1);
    GRAVURE_TRY(ZoneSet set, cluster(pieces, features, clusters, options.seed, watch));
    add_violations(limits, set);
    if (set.violations.empty() || clusters >= last) {
      return set;
    }
  }
}

}  // namespace

void take_k_means(const std::vector<Piece>& pieces, const ZoneLimits& limits, const ZoneWatch& watch, ZoneSet& set) {
  if (set.zones.size() <= set.lower_bound) {
    return;
  }
  Result<ZoneSet> fewer = fewest_clusters(pieces, limits, set.lower_bound, set.zones.size() - 1, {}, watch);
  if (!fewer || !fewer.value().violations.empty()) {
    return;
  }
  set.zones = std::move(fewer).value().zones;
  for (Zone& zone : set.zones) {
    zone = zone_of(pieces, zone.pieces, limits, zone.direction).value_or(zone);
  }
}

Result<ZoneSet> k_means_zones(const std::vector<Piece>& pieces, const ZoneLimits& limits, const KMeansZones& options,
                              const ZoneWatch& watch) {
  GRAVURE_CHECK(check_limits(pieces, limits));
  GRAVURE_TRY(const std::size_t bound, lower_bound_of(pieces, limits, watch));
  const std::size_t first = options.clusters > 0 ? options.clusters : bound;
  const std::size_t last = options.clusters > 0 ? options.clusters : pieces.size();
  GRAVURE_TRY(ZoneSet set, fewest_clusters(pieces, limits, first, last, options, watch));
  measure_zones(pieces, set.zones);
  set.lower_bound = bound;
  return set;
}

}  // namespace gravure::zones
