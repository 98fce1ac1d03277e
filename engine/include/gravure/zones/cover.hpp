#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/zones/cone.hpp"
#include "gravure/zones/piece.hpp"
#include "gravure/zones/zone_watch.hpp"

namespace gravure::zones {

struct ZoneLimits {
  double incidence_rad = 0;  ///< > 0, below pi/2: between the direction of a piece and that of its zone
  double field_mm = 0;       ///< side of the square scan field
};

/// Pieces that are marked from one direction.
struct Zone {
  std::vector<std::size_t> pieces;  ///< ascending
  Vector3 direction = Vector3::UnitZ();
  double max_incidence_rad = 0;  ///< of a piece to the direction
  double cone_rad = 0;           ///< half angle of the smallest cone round the pieces: no direction does better
  double max_pairwise_rad = 0;   ///< between two pieces, the measure of [D]
  double width_mm = 0;           ///< along x and y of the local frame
  double height_mm = 0;
};

struct ZoneSet {
  std::vector<Zone> zones;              ///< in the order of their first pieces
  std::size_t lower_bound = 0;          ///< proved: no set of zones within the limits has fewer
  std::size_t clusters = 0;             ///< k of k-means; 0 for the cover
  double inertia = 0;                   ///< J of [D]
  std::vector<std::string> violations;  ///< of the limits, where k was given
};

/// The fewest zones found such that every piece lies within the incidence limit of its zone's direction and every zone
/// within the scan field: proved the fewest where they are as many as the lower bound. Circles of the limit's size
/// through every two directions hold every set that any zone can have; of these (windows of the field where they are
/// larger) a cover is found by branch and bound. Where that is above the lower bound, k-means of seed 1 is tried with
/// fewer clusters and taken if these meet the limits. Then pieces go to the nearest zone as in k-means while no limit
/// breaks and the cones shrink. Each zone's cone is exact.
///
/// The lower bound is the fewest circles that hold all directions, where the search proves it, and never less than the
/// largest set found of pieces no two of which can share a zone. Errors: out_of_range for limits beyond their range;
/// cancelled.
Result<ZoneSet> cover_zones(const std::vector<Piece>& pieces, const ZoneLimits& limits, const ZoneWatch& watch = {});

struct KMeansZones {
  std::size_t clusters = 0;  ///< 0: the fewest that meet the limits
  bool normalised = true;    ///< false: positions in mm beside directions, which the publication warns of
  std::uint64_t seed = 1;
};

/// The published way: k-means on position and direction of each piece, positions scaled to 0 .. 1 by (x - min) / (max -
/// min); [D] divides by the maximum, which fails for parts about or off the origin. A zone's direction is the centre of
/// its directions, of length 1. A number of clusters that was given and breaks the limits is a result with violations.
Result<ZoneSet> k_means_zones(const std::vector<Piece>& pieces, const ZoneLimits& limits, const KMeansZones& options,
                              const ZoneWatch& watch = {});

}  // namespace gravure::zones
