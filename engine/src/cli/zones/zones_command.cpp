#include "zones/zones_command.hpp"

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <optional>

#include "gravure/zones/plan_zones.hpp"
#include "motion/motion_options.hpp"
#include "program/program_files.hpp"
#include "text_output.hpp"
#include "texture/texture_options.hpp"
#include "zones/zones_compile.hpp"
#include "zones/zones_input.hpp"
#include "zones/zones_plot.hpp"
#include "zones/zones_program.hpp"

namespace gravure::cli {
namespace {

using zones::PlannedZone;
using zones::ZonePlan;

struct ZonesArguments {
  std::string contours;
  std::string transform;
  std::string method = "cover";
  std::size_t k = 0;
  bool not_normalised = false;
  std::uint64_t seed = 1;
  double max_incidence_deg = 0;
  double layer_mm = 0;
  std::string machine;
  std::optional<double> field_mm;
  std::string plot;
};

Json vector_json(const kinematics::Vector3& vector) {
  return {figure(vector.x()), figure(vector.y()), figure(vector.z())};
}

Json stage_json(const kinematics::Machine& machine, const kinematics::JointPositions& joints) {
  Json stage = Json::object();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const bool turns = machine.joints[j].kind == kinematics::JointKind::revolute;
    stage[machine.joints[j].name] = figure(joints[j] * (turns ? kDegreesPerRad : 1));
  }
  return stage;
}

Json zone_json(const kinematics::Machine& machine, const std::vector<Contour>& contours, const ZonePlan& plan,
               const PlannedZone& zone) {
  Json ids = Json::array();
  Json parts = Json::array();
  for (const std::size_t i : zone.zone.pieces) {
    ids.push_back(contours[plan.pieces[i].contour].id);
    parts.push_back(plan.pieces[i].part);
  }
  Json frame = Json::array();
  const Eigen::Matrix4d matrix = zone.frame.matrix();
  for (int row = 0; row < 4; ++row) {
    frame.push_back({figure(matrix(row, 0)), figure(matrix(row, 1)), figure(matrix(row, 2)), figure(matrix(row, 3))});
  }
  Json layers = Json::array();
  for (const zones::PlannedLayer& layer : zone.layers) {
    double length = 0;
    for (const zones::Stroke& stroke : layer.strokes) {
      length += zones::length_mm(stroke.points_mm);
    }
    layers.push_back({{"z_mm", figure(layer.z_mm)},
                      {"stage", stage_json(machine, layer.joints)},
                      {"strokes", layer.strokes.size()},
                      {"length_mm", figure(length)}});
  }
  return {{"direction", vector_json(zone.frame.z)},
          {"origin", vector_json(zone.frame.origin_mm)},
          {"frame", frame},
          {"contours", ids},
          {"parts", parts},
          {"max_incidence_deg", figure(zone.zone.max_incidence_rad * kDegreesPerRad)},
          {"cone_deg", figure(zone.zone.cone_rad * kDegreesPerRad)},
          {"max_pairwise_deg", figure(zone.zone.max_pairwise_rad * kDegreesPerRad)},
          {"width_mm", figure(zone.zone.width_mm)},
          {"height_mm", figure(zone.zone.height_mm)},
          {"layer_mm", figure(zone.layer_thickness_mm)},
          {"layers", layers}};
}

Json plan_json(const ZonesArguments& options, const zones::ZonePlanRequest& request, const ZonePlan& plan) {
  Json zones = Json::array();
  for (const PlannedZone& zone : plan.zones) {
    zones.push_back(zone_json(request.machine, request.contours, plan, zone));
  }
  Json document = {{"method", options.method},
                   {"zones", zones},
                   {"lower_bound", plan.lower_bound},
                   {"added_for_travel", plan.added_for_travel},
                   {"contours", request.contours.size()},
                   {"length_mm", figure(plan.length_mm)},
                   {"tour",
                    {{"time_s", figure(plan.tour_time_s)},
                     {"naive_time_s", figure(plan.naive_time_s)},
                     {"proved", plan.is_tour_proved}}},
                   {"violations", plan.violations}};
  if (request.method == zones::Method::kmeans) {
    document["k"] = plan.clusters;
    document["inertia"] = figure(plan.inertia);
  }
  return document;
}

/// A zone without height is one layer.
std::string layer_text(double thickness_mm) {
  return thickness_mm > 0 ? fmt::format("{:.4f}", thickness_mm) : "flat";
}

std::string plan_text(const zones::ZonePlanRequest& request, const ZonePlan& plan) {
  std::string text = fmt::format("contours     {} of {:.3f} mm in all{}\n", request.contours.size(), plan.length_mm,
                                 plan.pieces.size() > request.contours.size()
                                     ? fmt::format(", cut into {} to fit the field", plan.pieces.size())
                                     : "");
  text += fmt::format("zones        {}, at least {}{}\n", plan.zones.size(), plan.lower_bound, travel_text(plan));
  text += fmt::format("stage moves  {:.3f} s{}, {:.3f} s as they come\n", plan.tour_time_s,
                      plan.is_tour_proved ? " (no order is faster)" : "", plan.naive_time_s);
  text += fmt::format("{:>5} {:>9} {:>14} {:>13} {:>7} {:>9}  {}\n", "zone", "contours", "incidence deg",
                      "pairwise deg", "layers", "layer mm", "direction");
  for (std::size_t z = 0; z < plan.zones.size(); ++z) {
    const PlannedZone& zone = plan.zones[z];
    const kinematics::Vector3& d = zone.frame.z;
    text +=
        fmt::format("{:>5} {:>9} {:>14.4f} {:>13.4f} {:>7} {:>9}  {:.5f}, {:.5f}, {:.5f}\n", z, zone.zone.pieces.size(),
                    zone.zone.max_incidence_rad * kDegreesPerRad, zone.zone.max_pairwise_rad * kDegreesPerRad,
                    zone.layers.size(), layer_text(zone.layer_thickness_mm), d.x() + 0.0, d.y() + 0.0, d.z() + 0.0);
  }
  for (const std::string& violation : plan.violations) {
    text += "violation: " + violation + "\n";
  }
  return text;
}

Result<int> plan_contours(const ZonesArguments& options, const Command& command) {
  GRAVURE_CHECK(refuse_overwrite({{"--plot", options.plot}}, {options.contours, options.transform, options.machine}));
  if (options.method == "cover" && (options.k > 0 || options.not_normalised)) {
    return Error{ErrorCode::bad_argument, "--k and --not-normalised belong to --method kmeans"};
  }
  zones::ZonePlanRequest request;
  GRAVURE_TRY(request.contours, load_contours(options.contours));
  if (!options.transform.empty()) {
    GRAVURE_CHECK(move_contours(options.transform, options.contours, request.contours));
  }
  GRAVURE_TRY(request.machine, load_zones_machine(options.machine, options.field_mm));
  request.method = options.method == "cover" ? zones::Method::cover : zones::Method::kmeans;
  request.kmeans = {options.k, !options.not_normalised, options.seed};
  request.max_incidence_rad = options.max_incidence_deg / kDegreesPerRad;
  request.max_layer_mm = options.layer_mm;
  const Result<ZonePlan> planned = [&request] {
    ProgressBar bar("plan zones", "steps");
    request.watch = {&cancel_token(), &bar};
    return zones::plan_zones(request);
  }();
  GRAVURE_TRY(const ZonePlan plan, planned);
  if (!options.plot.empty()) {
    GRAVURE_CHECK(write_texts({{options.plot, zones_to_svg(plan, options.contours)}}));
  }
  if (command.json) {
    print_json(plan_json(options, request, plan));
  } else {
    print(plan_text(request, plan));
  }
  return plan.violations.empty() ? kDone : kLimitViolated;
}

void add_plan_verb(CLI::App& parent, Command& command) {
  CLI::App* verb = add_verb(parent, command, "plan", "Contours -> zones, layers and stage positions");
  const auto options = std::make_shared<ZonesArguments>();
  verb->add_option("contours", options->contours, "Contours as JSON or CSV")->required();
  verb->add_option("--transform", options->transform, "Where the part is: JSON with transform[4][4]");
  verb->add_option("--method", options->method, "cover: the fewest zones; kmeans: the published way")
      ->check(CLI::IsMember({"cover", "kmeans"}))
      ->capture_default_str();
  verb->add_option("--k", options->k, "Clusters of k-means; left out: the fewest that meet the limits")
      ->check(integer_from(1, 1'000'000));
  verb->add_flag("--not-normalised", options->not_normalised, "k-means on positions in mm as they are");
  add_integer(*verb, "--seed", options->seed, "Of the starts of k-means", 0, std::numeric_limits<std::int64_t>::max());
  verb->add_option("--max-incidence-deg", options->max_incidence_deg, "Between a contour's direction and its zone's")
      ->check(number_from(1e-3, 89))
      ->required();
  verb->add_option("--layer-mm", options->layer_mm, "Thickness of a layer at most")
      ->check(number_from(1e-4, 1e6))
      ->required();
  verb->add_option("--machine", options->machine, "Machine file (TOML); left out: an example with a field of 60 mm");
  verb->add_option("--field-mm", options->field_mm, "Side of the scan field, in place of the machine's")
      ->check(number_from(1e-3, 1e6));
  verb->add_option("--plot", options->plot, "Picture of the zones as SVG");
  set_run(*verb, command, options, plan_contours);
}

}  // namespace

void add_zones(CLI::App& app, Command& command) {
  CLI::App* zones = app.add_subcommand("zones", "Contours on a part that looks to many sides, zone by zone");
  zones->require_subcommand(1);
  add_plan_verb(*zones, command);
  add_zones_compile(*zones, command);
}

}  // namespace gravure::cli
