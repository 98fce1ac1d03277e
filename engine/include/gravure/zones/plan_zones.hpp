#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gravure/core/contour.hpp"
#include "gravure/zones/cover.hpp"
#include "gravure/zones/layers.hpp"
#include "gravure/zones/local_frame.hpp"
#include "gravure/zones/tour.hpp"

namespace gravure::zones {

enum class Method : std::uint8_t { cover, kmeans };

struct ZonePlanRequest {
  std::vector<Contour> contours;
  Method method = Method::cover;
  KMeansZones kmeans;
  double max_incidence_rad = 0;
  double max_layer_mm = 0;
  Machine machine;  ///< its head's field_mm is the scan field
  ZoneWatch watch;
};

/// One layer of a zone: where the stages stand and what the galvo marks.
struct PlannedLayer {
  double z_mm = 0;  ///< local height of the focal plane
  JointPositions joints;
  std::vector<Stroke> strokes;  ///< along each contour in its own sense
};

struct PlannedZone {
  Zone zone;
  LocalFrame frame;  ///< origin in the middle of the zone
  double layer_thickness_mm = 0;
  std::vector<PlannedLayer> layers;  ///< top first
};

/// Zones in the order in which they are marked.
struct ZonePlan {
  std::vector<Piece> pieces;
  std::vector<PlannedZone> zones;
  std::size_t lower_bound = 0;
  std::size_t added_for_travel = 0;  ///< zones more, for contours that are within travel only apart
  std::size_t clusters = 0;
  double inertia = 0;
  double length_mm = 0;  ///< of all contours
  double tour_time_s = 0;
  double naive_time_s = 0;
  bool is_tour_proved = false;
  std::vector<std::string> violations;
};

/// From contours on the part to zones, layers and stage positions. Every point of every stroke is put through the
/// machine: violations name what lies outside the scan field or more than half a layer from focus. out_of_range for
/// more than 10,000 contours or parts of them and for more than 500 zones, cancelled, and errors as the parts'.
Result<ZonePlan> plan_zones(const ZonePlanRequest& request);

/// An X-Y-Z-A-C machine as in [A] with the A and C axes meeting at the origin of the part, for plans without a machine
/// file: 100 mm/s, 1 m/s^2, 20 m/s^3; 90 deg/s, 360 deg/s^2, 3600 deg/s^3, A from -120 to 120 deg; a field of 60 mm. U
/// and V as in [A] table 1, whose jerk is read as m/s^2 per ms: 20 m/s^2, 1000 m/s^3; their speed, 2 m/s, decides
/// nothing there and is what such heads reach.
Machine example_machine();

}  // namespace gravure::zones
