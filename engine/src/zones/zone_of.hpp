#pragma once

#include <optional>

#include "gravure/zones/cover.hpp"
#include "gravure/zones/local_frame.hpp"

namespace gravure::zones {

/// What rounding may add to an angle and to a length on the field.
inline constexpr double kAngleSlack = 1e-10;
inline constexpr double kFieldSlackMm = 1e-9;

/// The box of points in a frame.
struct Extent {
  Vector3 least = Vector3::Zero();
  Vector3 most = Vector3::Zero();
  void add(const Extent& other) noexcept;
};
Extent extent_of(const Piece& piece, const LocalFrame& frame) noexcept;
Extent extent_of(const std::vector<Piece>& pieces, const std::vector<std::size_t>& which, const LocalFrame& frame);

/// The axes `angle` away from both directions; none where they are farther apart than that reaches.
std::vector<Vector3> axes_through(const Vector3& a, const Vector3& b, double angle);

/// The frame of a direction of length 1, its origin that of the part.
LocalFrame frame_of(const Vector3& direction);

/// The pieces seen from `direction`. What does not depend on that, measure_zones() finds out, once.
Zone describe_zone(const std::vector<Piece>& pieces, std::vector<std::size_t> which, const Vector3& direction);
bool is_within(const Zone& zone, const ZoneLimits& limits) noexcept;

/// The zone of these pieces: seen along the axis of their smallest cone, or, where they are too large for the field
/// from there, along `other`. Nothing where neither meets the limits.
std::optional<Zone> zone_of(const std::vector<Piece>& pieces, const std::vector<std::size_t>& which,
                            const ZoneLimits& limits, const Vector3& other);

Result<void> check_limits(const std::vector<Piece>& pieces, const ZoneLimits& limits);

/// Zones ordered by their first pieces.
void sort_zones(std::vector<Zone>& zones);

/// Cone and largest angle between two pieces of zones that are made: every pair is looked at.
void measure_zones(const std::vector<Piece>& pieces, std::vector<Zone>& zones);

/// Pieces that could share no zone, whatever its direction: their directions are more than twice the limit apart, or
/// points of them farther than the field's diagonal seen from any direction within the limit of both.
bool are_apart(const Piece& a, const Piece& b, const ZoneLimits& limits);

/// Moves pieces to the zone whose direction is nearest, as k-means does, while the limits hold, the squared angles
/// shrink and `watch` goes on.
void refine_zones(const std::vector<Piece>& pieces, const ZoneLimits& limits, const ZoneWatch& watch,
                  std::vector<Zone>& zones);

/// The zones of k-means in place of those of `set` where they are fewer and within the limits; tried from the bound up.
void take_k_means(const std::vector<Piece>& pieces, const ZoneLimits& limits, const ZoneWatch& watch, ZoneSet& set);

/// A number of zones that no set of zones within the limits goes below; cancelled.
Result<std::size_t> lower_bound_of(const std::vector<Piece>& pieces, const ZoneLimits& limits, const ZoneWatch& watch);

}  // namespace gravure::zones
