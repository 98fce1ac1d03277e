#include "gravure/formats/motion_json.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace gravure::formats {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// Twelve digits: what follows them is the rounding of sums in binary, which differs between compilers and tells nobody
/// anything.
void round_figures(Json& json) {
  if (json.is_number_float()) {
    const std::string text = fmt::format("{:.12g}", json.get<double>());
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    json = value;
  }
  if (json.is_structured()) {
    for (Json& each : json) {
      round_figures(each);
    }
  }
}

std::string text_of(Json json) {
  round_figures(json);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json json_of(const motion::Candidate& candidate) {
  return {{"v", candidate.v_mm_s},
          {"a_up", candidate.a_up_mm_s2},
          {"a_down", candidate.a_down_mm_s2},
          {"s_factor", candidate.s_factor},
          {"positioning_time_s", number(candidate.positioning_time_s)}};
}

Json json_of(const motion::Alternative& row) {
  Json json = {{"name", row.name},
               {"access_time_s", number(row.access_time_s)},
               {"positioning_time_s", number(row.positioning_time_s)},
               {"worst_positioning_time_s", number(row.worst_positioning_time_s)},
               {"envelope_time_s", number(row.envelope_time_s)},
               {"residual_at_access", number(row.residual)}};
  if (row.profile) {
    json["profile"] = json_of(*row.profile);
    json["profile"].erase("positioning_time_s");
  }
  return json;
}

Json json_of(const motion::GridSearch& grid) {
  return {{"evaluated", grid.evaluated}, {"best", json_of(grid.best)}};
}

Json json_of(const motion::Mode& mode) {
  return {{"f_hz", mode.f_hz}, {"zeta", mode.zeta}, {"participation", mode.participation}};
}

Json json_of(const motion::Profile& profile) {
  return {{"stroke_mm", profile.stroke_mm},
          {"access_time_s", profile.access_time_s()},
          {"times_s", profile.times_s},
          {"velocity_constants", profile.velocity_mm_s},
          {"position_constants", profile.position_mm},
          {"acceleration_constants", profile.acceleration_mm_s2},
          {"jerk_constants", profile.jerk_mm_s3},
          {"end_velocity_mm_s", profile.end_velocity_mm_s},
          {"peak_velocity_mm_s", profile.peak_velocity_mm_s},
          {"peak_acceleration_up_mm_s2", profile.peak_acceleration_up_mm_s2},
          {"peak_acceleration_down_mm_s2", profile.peak_acceleration_down_mm_s2},
          {"reduced",
           {{"velocity", profile.reduced.velocity},
            {"acceleration", profile.reduced.acceleration()},
            {"acceleration_up", profile.reduced.acceleration_up},
            {"acceleration_down", profile.reduced.acceleration_down}}}};
}

}  // namespace

std::string profile_to_json(const motion::Profile& profile) {
  return text_of(json_of(profile));
}

std::string synchronised_to_json(const motion::SynchronisedMove& move) {
  Json axes = Json::array();
  for (const motion::Profile& profile : move.axes) {
    axes.push_back(json_of(profile));
  }
  return text_of({{"access_time_s", move.access_time_s}, {"slowest_axis", move.slowest_axis}, {"axes", axes}});
}

std::string response_to_json(const Response& response) {
  Json modes = Json::array();
  for (const motion::Mode& mode : response.modes) {
    modes.push_back(json_of(mode));
  }
  const bool of_position = response.band.of == motion::BandOf::position;
  return text_of({{"access_time_s", number(response.settling.access_time_s)},
                  {"positioning_time_s", number(response.settling.positioning_time_s)},
                  {"residual_after_s", number(response.settling.residual_after_s())},
                  {"envelope_time_s", number(response.settling.envelope_time_s)},
                  {"residual_at_access", number(response.residual)},
                  {"band", {{of_position ? "mm" : "mm_s2", response.band.tolerance}}},
                  {"quantised_update_us", response.update_us > 0 ? Json(response.update_us) : Json(nullptr)},
                  {"delay_s", response.delay_s},
                  {"modes", modes}});
}

std::string search_to_json(const motion::SearchReport& report) {
  Json rows = Json::array();
  for (const motion::Alternative& row : report.alternatives) {
    rows.push_back(json_of(row));
  }
  Json grids = nullptr;
  if (report.grids) {
    grids = {{"symmetric", json_of(report.grids->symmetric)}, {"asymmetric", json_of(report.grids->asymmetric)}};
  }
  return text_of({{"best", json_of(report.best)},
                  {"evaluated", report.evaluated},
                  {"grids", grids},
                  {"shortest", report.shortest},
                  {"shortest_worst", report.shortest_worst},
                  {"verdict", report.verdict},
                  {"alternatives", rows}});
}

std::string identification_to_json(const motion::Identification& identification) {
  Json modes = Json::array();
  for (const motion::IdentifiedMode& mode : identification.modes) {
    modes.push_back({{"f_hz", mode.mode.f_hz},
                     {"f_sd_hz", mode.f_sd_hz},
                     {"zeta", mode.mode.zeta},
                     {"zeta_sd", mode.zeta_sd},
                     {"participation", mode.mode.participation},
                     {"participation_sd", mode.participation_sd},
                     {"resolution_hz", number(mode.resolution_hz)}});
  }
  return text_of({{"modes", modes},
                  {"participation_is_absolute", identification.participation_is_absolute},
                  {"offset_mm_s2", identification.offset_mm_s2},
                  {"noise_sd_mm_s2", identification.noise_sd_mm_s2},
                  {"samples", identification.samples},
                  {"record_s", identification.record_s},
                  {"sample_hz", identification.sample_hz},
                  {"warnings", identification.warnings}});
}

std::string unreversed_to_json(const std::vector<UnreversedAxis>& axes, const ToolPathSummary& tool) {
  Json list = Json::array();
  for (const UnreversedAxis& axis : axes) {
    list.push_back({{"name", axis.name},
                    {"tolerance_deg", axis.tolerance_deg},
                    {"reversals_before", axis.result.reversals_before},
                    {"reversals_after", axis.result.reversals_after},
                    {"control_points", axis.result.control_points},
                    {"largest_deviation_deg", axis.result.largest_deviation},
                    {"rms_deviation_deg", axis.result.rms_deviation},
                    {"turns", axis.result.turns},
                    {"published_shift",
                     {{"shift_deg", axis.shift_deg},
                      {"reversals_after", axis.shifted.reversals_after},
                      {"largest_deviation_deg", axis.shifted.largest_deviation},
                      {"rms_deviation_deg", axis.shifted.rms_deviation}}}});
  }
  Json json = {{"axes", list}};
  if (tool.clearance_mm) {
    json["interference"] = {{"clearance_mm", number(*tool.clearance_mm)},
                            {"turned_blocks", tool.turned_blocks},
                            {"largest_turn_deg", tool.largest_turn_deg}};
  }
  if (tool.rewritten) {
    json["rewritten"] = {{"changed_lines", tool.rewritten->changed_lines},
                         {"largest_tilt_deg", tool.rewritten->largest_tilt_deg},
                         {"largest_shift_mm", tool.rewritten->largest_shift_mm},
                         {"largest_error_mm", tool.rewritten->largest_error_mm}};
  }
  return text_of(json);
}

}  // namespace gravure::formats
