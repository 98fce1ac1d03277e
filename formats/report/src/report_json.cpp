#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "gravure/formats/png_writer.hpp"
#include "gravure/formats/report_page.hpp"
#include "json_parts.hpp"

namespace gravure {
namespace {

using report::Extent;

Json png_of(std::span<const std::byte> pixels, const Extent& extent, Result<void>& failed) {
  const Result<std::string> png = encode_png({extent.width, extent.height, 1, pixels});
  if (!png) {
    failed = png.error();
    return nullptr;
  }
  return base64(png.value());
}

Json job_json(const report::ReportData& data) {
  const Plan& plan = data.header->plan;
  const double circumference_mm = to_double(plan.rotary.circumference_um) / 1000;
  return {{"title", plan.title},
          {"mode", mode_name(plan.mode)},
          {"fires", data.header->fires == Fires::white ? "white" : "black"},
          {"lines_along", data.header->lines_along == LinesAlong::rows ? "rows" : "columns"},
          {"revolutions", plan.job.revolutions},
          {"layers", data.pictures.layers.size()},
          {"lines_per_revolution", plan.rotary.lines_per_revolution},
          {"columns", image_columns(plan)},
          {"pixels_per_line", plan.line.pixels},
          {"bands", plan.bands ? Json(plan.bands->count) : Json(nullptr)},
          {"circumference_mm", circumference_mm},
          {"diameter_mm", circumference_mm / 3.14159265358979323846},
          {"length_mm", to_double(plan.line.pixel_pitch_um) * static_cast<double>(image_columns(plan)) / 1000},
          {"pixel_pitch_um", json_of(plan.line.pixel_pitch_um)},
          {"line_pitch_um", json_of(plan.rotary.line_pitch_um)},
          {"ticks", std::to_string(plan.job.ticks)},
          {"duration_s", json_of(plan.job.duration_s)},
          {"total_s", plan.spin ? json_of(plan.spin->total_s) : Json(nullptr)},
          {"rpm", figure(to_double(plan.rotary.rpm))},
          {"surface_mm_s", figure(to_double(plan.rotary.surface_speed_mm_s))},
          {"scan_m_s", figure(to_double(plan.line.scan_speed_m_s))},
          {"bidirectional", plan.line.bidirectional},
          {"offset_slots", plan.line.offset_slots},
          {"offset_remainder_ticks", plan.line.offset_remainder_ticks},
          {"warnings", plan.warnings}};
}

Json counter_json(const AbPlan& ab, const Rational& edges_per_revolution) {
  return {{"bits", ab.counter_bits},
          {"prescaler", std::to_string(ab.prescaler)},
          {"increment", std::to_string(ab.increment)},
          {"fraction_num", std::to_string(ab.fraction_num)},
          {"fraction_den", std::to_string(ab.fraction_den)},
          {"wanted_hz", json_of(ab.wanted_hz)},
          {"output_hz", json_of(ab.output_hz)},
          {"exact", ab.exact},
          {"drift_um_per_revolution", json_of(ab.drift_um_per_revolution)},
          {"edges_per_revolution", json_of(edges_per_revolution)},
          {"lines_until_limit", ab.lines_until_limit ? Json(to_string(*ab.lines_until_limit)) : Json(nullptr)},
          {"bound_lines_until_limit", to_string(ab.bound_lines_until_limit)}};
}

Json clock_json(const Plan& plan) {
  Json json = {{"seed_hz", plan.clock.seed_hz},
               {"fpga_hz", plan.clock.fpga_hz},
               {"multiplier", plan.clock.fpga_hz / plan.clock.seed_hz},
               {"pulse_divider", plan.clock.pulse_divider},
               {"pulse_hz", json_of(plan.clock.pulse_hz)},
               {"ticks_per_slot", plan.clock.ticks_per_slot},
               {"slots_per_line", plan.line.slots},
               {"slots_per_microvector", plan.line.slots_per_microvector},
               {"ticks_per_line", plan.line.ticks},
               {"line_hz", json_of(plan.line.rate_hz)},
               {"lines_per_revolution", plan.rotary.lines_per_revolution},
               {"ticks_per_revolution", std::to_string(plan.rotary.ticks_per_revolution)},
               {"encoder_lines", plan.rotary.encoder_lines},
               {"interpolation_bits", plan.rotary.interpolation_bits},
               {"gear", {plan.rotary.gear_encoder_turns, plan.rotary.gear_workpiece_turns}},
               {"counter", counter_json(plan.ab, plan.rotary.edges_per_revolution)},
               {"carriage", nullptr}};
  if (plan.carriage) {
    json["carriage"] = counter_json(plan.carriage->ab, plan.carriage->edges_per_revolution);
    json["carriage"]["feed_um"] = figure(to_double(plan.carriage->feed_um));
    json["carriage"]["feed_pixels"] = to_string(plan.carriage->feed_pixels);
  }
  return json;
}

Json seam_json(const report::ReportData& data) {
  const VerifyReport& verified = data.verified;
  Json points = Json::array();
  for (const report::SeamPoint& point : data.seam.points) {
    points.push_back({point.revolution, figure(point.drift_um)});
  }
  Json json = {
      {"limit_um", data.seam.limit_um},
      {"max_um", figure(verified.seam_max_um)},
      {"worst_revolution", verified.seam_worst_revolution},
      {"worst_line", verified.seam_worst_line},
      {"end_um", figure(verified.seam_end_um)},
      {"measured_end_um", verified.seam_end_measured_um ? Json(figure(*verified.seam_end_measured_um)) : Json(nullptr)},
      {"bound_um_per_revolution", figure(data.seam.bound_um_per_revolution)},
      {"axis_error_max_um", figure(verified.axis_error_max_um)},
      {"ab_step_um", figure(verified.ab_step_um)},
      {"points", points},
      {"carriage", nullptr}};
  if (verified.carriage) {
    json["carriage"] = {{"end_um", figure(verified.carriage->seam_end_um)},
                        {"error_max_um", figure(verified.carriage->error_max_um)},
                        {"ab_step_um", figure(verified.carriage->ab_step_um)}};
  }
  return json;
}

Json error_json(const report::ReportData& data) {
  if (!data.verified.error) {
    return nullptr;
  }
  const ErrorBudget& budget = *data.verified.error;
  Json terms = Json::array();
  for (const ErrorTerm term : kAllErrorTerms) {
    const auto i = static_cast<std::size_t>(term);
    terms.push_back({{"name", std::string(term_name(term))},
                     {"on", budget.enabled[i]},
                     {"um", budget.budget_um[i] ? Json(figure(*budget.budget_um[i])) : Json(nullptr)}});
  }
  const Limits& limits = data.job.limits;
  return {{"terms", terms},
          {"max_um", figure(budget.max_um)},
          {"rms_um", figure(budget.rms_um)},
          {"simulated_max_um", figure(budget.simulated_max_um)},
          {"simulated_pulses", budget.simulated_pulses},
          {"worst", {budget.worst.revolution, budget.worst.line, budget.worst.slot}},
          {"limit_um", limits.landing_um ? Json(to_double(*limits.landing_um)) : Json(nullptr)},
          {"defocus_um", budget.defocus_max_um ? Json(figure(*budget.defocus_max_um)) : Json(nullptr)},
          {"defocus_limit_um", limits.defocus_um ? Json(to_double(*limits.defocus_um)) : Json(nullptr)},
          {"notes", budget.notes}};
}

Result<Json> layers_json(const report::ReportData& data) {
  const report::LayerPictures& pictures = data.pictures;
  Result<void> failed;
  Json layers = Json::array();
  for (const report::LayerPicture& layer : pictures.layers) {
    Json json = {
        {"layer", layer.layer},
        {"source", layer.source},
        {"level", layer.level},
        {"revolutions", layer.revolutions},
        {"fired", layer.fired_pixels},
        {"share", figure(static_cast<double>(layer.fired_pixels) / static_cast<double>(pictures.picture.area()))}};
    if (!layer.shares.empty()) {
      json["png"] = png_of(layer.shares, pictures.cells, failed);
      json["seam_png"] = png_of(layer.seam, pictures.seam_extent(), failed);
    }
    layers.push_back(std::move(json));
  }
  GRAVURE_CHECK(failed);
  Json columns = Json::array();
  const double exposures = static_cast<double>(std::max<std::int64_t>(1, pictures.exposures));
  for (std::size_t i = 0; i < pictures.column_pulses.size(); ++i) {
    columns.push_back(figure(static_cast<double>(pictures.column_pulses[i]) /
                             (static_cast<double>(pictures.column_pixels[i]) * exposures)));
  }
  const Extent seam = pictures.seam_extent();
  return Json{{"width", pictures.picture.width},
              {"height", pictures.picture.height},
              {"cells", {pictures.cells.width, pictures.cells.height}},
              {"lines_are_rows", pictures.lines_are_rows},
              {"seam",
               {{"width", seam.width},
                {"height", seam.height},
                {"lines_each", pictures.seam_place.lines_each},
                {"first_column", pictures.seam_place.first_column},
                {"columns", pictures.seam_place.columns}}},
              {"exposures", pictures.exposures},
              {"layers", std::move(layers)},
              {"columns", std::move(columns)}};
}

Json relief_json(const report::ReportData& data) {
  const report::Relief& relief = data.relief;
  Json removal = nullptr;
  if (data.removal) {
    removal = {{"spot_um", figure(2 * data.removal->waist_um)},
               {"fluence_j_cm2", figure(data.removal->fluence_j_cm2)},
               {"threshold_j_cm2", figure(data.removal->threshold_j_cm2)},
               {"penetration_nm", figure(1000 * data.removal->penetration_um)},
               {"crater_um", figure(2 * data.removal->radius_um(0))},
               {"depth_um", figure(data.removal->depth_um(0))}};
  }
  return {{"unit", relief.in_um ? "um" : "pulses"},
          {"deepest", figure(relief.deepest)},
          {"mean", figure(relief.mean)},
          {"cells", sixteen_bits(relief.cells, relief.deepest)},
          {"seam_deepest", figure(relief.seam_deepest)},
          {"seam", sixteen_bits(relief.seam, relief.seam_deepest)},
          {"removal", removal},
          {"absent", report::absent_removal_keys(data.job.laser)}};
}

}  // namespace

Result<std::string> report_json(const report::ReportData& data) {
  const VerifyReport& verified = data.verified;
  Json sources = Json::array();
  for (const SourceImage& source : data.header->sources) {
    sources.push_back({{"path", source.path},
                       {"page", source.page},
                       {"width", source.width},
                       {"height", source.height},
                       {"sha256", source.sha256}});
  }
  Json files = Json::array();
  for (const SourceImage& file : data.header->files) {
    files.push_back({{"path", file.path}, {"sha256", file.sha256}});
  }
  GRAVURE_TRY(Json layers, layers_json(data));
  Json json = report_head(data);
  json["verdict"].update({{"images_compared", verified.images_compared},
                          {"wrong_pixels", verified.wrong_pixels},
                          {"pixels", verified.pixels},
                          {"fired_pixels", verified.fired_pixels}});
  json.update({{"job", job_json(data)},
               {"clock", clock_json(data.header->plan)},
               {"seam", seam_json(data)},
               {"error", error_json(data)},
               {"line", line_json(data.line)},
               {"pictures", std::move(layers)},
               {"relief", relief_json(data)},
               {"sources", sources},
               {"files", files}});
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gravure
