#include "gravure/zones/plan_zones.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gravure/kinematics/machines.hpp"
#include "zone_of.hpp"
#include "zone_travel.hpp"

namespace gravure::zones {
namespace {

constexpr std::size_t kMostViolations = 20;
/// The times between all of them are in memory at once.
constexpr std::size_t kMostZones = 500;

Result<void> check_count(std::size_t zones, const ZonePlanRequest& request) {
  if (zones > kMostZones) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("max_incidence_deg = {:.6g}: {} zones: at most {} are put in order: allow more incidence, "
                             "or give a larger field or part of the contours",
                             request.max_incidence_rad * 180 / std::numbers::pi, zones, kMostZones)};
  }
  return {};
}

Result<ZoneSet> zones_of(const std::vector<Piece>& pieces, const ZonePlanRequest& request, const ZoneLimits& limits) {
  GRAVURE_TRY(ZoneSet set, request.method == Method::cover
                               ? cover_zones(pieces, limits, request.watch)
                               : k_means_zones(pieces, limits, request.kmeans, request.watch));
  GRAVURE_CHECK(check_count(set.zones.size(), request));
  return set;
}

/// Frame, layers and strokes of a zone; the joints come with the tour.
Result<PlannedZone> lay_out(const std::vector<Piece>& pieces, const Zone& zone, double max_layer_mm) {
  PlannedZone planned;
  planned.zone = zone;
  planned.frame = frame_of(zone.direction);
  const Extent extent = extent_of(pieces, zone.pieces, planned.frame);
  planned.frame.origin_mm = planned.frame.to_part((extent.least + extent.most) / 2);
  const Extent centred = extent_of(pieces, zone.pieces, planned.frame);
  GRAVURE_TRY(const LayerStack stack, layer_stack(centred.least.z(), centred.most.z(), max_layer_mm));
  planned.layer_thickness_mm = stack.thickness_mm;
  std::vector<std::vector<Stroke>> by_layer(stack.count);
  for (Stroke& stroke : cut_layers(pieces, zone.pieces, planned.frame, stack)) {
    by_layer[stroke.layer].push_back(std::move(stroke));
  }
  for (std::size_t layer = 0; layer < stack.count; ++layer) {
    if (!by_layer[layer].empty()) {  // nothing to stop for
      planned.layers.push_back({stack.centre_mm(layer), {}, std::move(by_layer[layer])});
    }
  }
  return planned;
}

Stops stops_of(const PlannedZone& zone) {
  Stops stops;
  for (const PlannedLayer& layer : zone.layers) {
    stops.layers.push_back({zone.frame.to_part({0, 0, layer.z_mm}), zone.frame.z});
  }
  return stops;
}

/// Farthest into the field and off focus that the machine sees of a layer.
struct Reach {
  double field_mm = 0;
  double focus_mm = 0;
};

Result<Reach> reach_of(const Machine& machine, const PlannedZone& zone, const PlannedLayer& layer) {
  Reach reach;
  for (const Stroke& stroke : layer.strokes) {
    for (const Vector3& point : stroke.points_mm) {
      GRAVURE_TRY(const kinematics::FieldPoint at,
                  kinematics::field_of(machine, layer.joints, zone.frame.to_part(point)));
      reach.field_mm = std::max({reach.field_mm, std::abs(at.u_mm), std::abs(at.v_mm)});
      reach.focus_mm = std::max(reach.focus_mm, std::abs(at.w_mm));
    }
  }
  return reach;
}

Result<void> check_reach(const Machine& machine, ZonePlan& plan) {
  constexpr double kRounding_mm = 1e-6;
  for (std::size_t z = 0; z < plan.zones.size(); ++z) {
    const PlannedZone& zone = plan.zones[z];
    for (std::size_t l = 0; l < zone.layers.size() && plan.violations.size() < kMostViolations; ++l) {
      GRAVURE_TRY(const Reach reach, reach_of(machine, zone, zone.layers[l]));
      if (reach.field_mm > machine.head.field_mm / 2 + kRounding_mm) {
        plan.violations.push_back(
            fmt::format("zone {}, layer {}: the galvo must reach {:.3f} mm, its field allows {:.3f}", z, l,
                        reach.field_mm, machine.head.field_mm / 2));
      }
      if (reach.focus_mm > zone.layer_thickness_mm / 2 + kRounding_mm) {
        plan.violations.push_back(fmt::format("zone {}, layer {}: {:.4f} mm off focus, half a layer is {:.4f}", z, l,
                                              reach.focus_mm, zone.layer_thickness_mm / 2));
      }
    }
  }
  return {};
}

}  // namespace

Result<ZonePlan> plan_zones(const ZonePlanRequest& request) {
  GRAVURE_CHECK(check_machine(request.machine));
  ZonePlan plan;
  // Between two set-points the mirrors follow a cubic, which swings out by fractions of a micrometre where a stroke
  // ends.
  constexpr double kSwing_mm = 0.002;
  const double field_mm = request.machine.head.field_mm;
  const ZoneLimits limits{request.max_incidence_rad, field_mm - 2 * std::min(kSwing_mm, field_mm / 100)};
  GRAVURE_TRY(plan.pieces, cut_to_field(request.contours, limits.field_mm));
  GRAVURE_CHECK(request.watch.go_on());
  GRAVURE_TRY(const ZoneSet set, zones_of(plan.pieces, request, limits));
  plan.lower_bound = set.lower_bound;
  plan.clusters = set.clusters;
  plan.inertia = set.inertia;
  plan.violations = set.violations;
  std::vector<PlannedZone> zones;
  std::vector<Stops> stops;
  const ZoneCheck is_reached = [&](const Zone& zone) -> Result<void> {
    GRAVURE_TRY(const PlannedZone planned, lay_out(plan.pieces, zone, request.max_layer_mm));
    return check_travel(request.machine, stops_of(planned));
  };
  for (const Zone& zone : set.zones) {
    GRAVURE_CHECK(request.watch.go_on());
    request.watch.tell(ZonePart::travel, zones.size(), set.zones.size() + plan.added_for_travel);
    GRAVURE_TRY(const std::vector<Zone> parts,
                zones_within_travel(request.contours, plan.pieces, limits, request.machine, is_reached, zone));
    plan.added_for_travel += parts.size() - 1;
    for (const Zone& part : parts) {
      GRAVURE_TRY(PlannedZone planned, lay_out(plan.pieces, part, request.max_layer_mm));
      stops.push_back(stops_of(planned));
      zones.push_back(std::move(planned));
    }
  }
  GRAVURE_CHECK(check_count(zones.size(), request));
  const JointPositions start(request.machine.joints.size(), 0);
  GRAVURE_TRY(const Tour tour, plan_tour(request.machine, stops, start, request.watch));
  plan.tour_time_s = tour.time_s;
  plan.naive_time_s = tour.naive_time_s;
  plan.is_tour_proved = tour.is_proved;
  for (std::size_t step = 0; step < tour.order.size(); ++step) {
    PlannedZone& zone = zones[tour.order[step]];
    for (std::size_t layer = 0; layer < zone.layers.size(); ++layer) {
      zone.layers[layer].joints = tour.poses[step][layer];
    }
    plan.zones.push_back(std::move(zone));
  }
  for (const Piece& piece : plan.pieces) {
    plan.length_mm += zones::length_mm(piece.points_mm);
  }
  if (plan.violations.empty()) {  // zones beyond the limits are violations already
    GRAVURE_CHECK(check_reach(request.machine, plan));
  }
  return plan;
}

Machine example_machine() {
  constexpr double kRadians = std::numbers::pi / 180;
  kinematics::ScanHead head;
  head.field_mm = 60;
  head.resolution_bits = 20;
  head.max_speed_mm_s = 2000;
  head.max_acceleration_mm_s2 = 20'000;
  head.max_jerk_mm_s3 = 1'000'000;
  Machine machine = kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, Vector3::Zero(), head);
  for (kinematics::Joint& joint : machine.joints) {
    const bool is_linear = joint.kind == kinematics::JointKind::prismatic;
    joint.limits.max_speed = is_linear ? 100 : 90 * kRadians;
    joint.limits.max_acceleration = is_linear ? 1000 : 360 * kRadians;
    joint.limits.max_jerk = is_linear ? 20'000 : 3600 * kRadians;
    if (joint.name == "A") {
      joint.limits.least = -120 * kRadians;
      joint.limits.most = 120 * kRadians;
    }
  }
  return machine;
}

}  // namespace gravure::zones
