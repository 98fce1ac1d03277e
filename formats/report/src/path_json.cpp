#include <algorithm>
#include <cmath>

#include "gravure/formats/report_page.hpp"
#include "json_parts.hpp"

namespace gravure {
namespace {

Json allowed(const std::optional<Rational>& value) {
  return value ? Json(to_double(*value)) : Json(nullptr);
}

/// A figure of all pulses beside what the job allows.
Json judged(const char* name, const char* unit, const PulseFigure& found, const Json& limit) {
  return {{"name", name},
          {"unit", unit},
          {"max", figure(found.max)},
          {"rms", figure(found.rms)},
          {"worst_pulse", found.worst_pulse < 0 ? Json(nullptr) : Json(found.worst_pulse)},
          {"limit", limit}};
}

/// A place of an axis: a nanometre or a millionth of a degree is what a page can show; what is less is the rounding of
/// set-points.
double place(double value) {
  return std::round(value * 1e6) / 1e6 + 0.0;
}

Json figures_json(const PathReport& report, const PathPlan& path) {
  Json figures = Json::array();
  if (report.points_compared) {
    figures.push_back(judged("focus offset", "\u00b5m", report.focus_offset_um, allowed(path.max_focus_offset_um)));
    figures.push_back(judged("incidence", "\u00b0", report.incidence_deg, allowed(path.max_incidence_deg)));
    figures.push_back(judged("landing", "\u00b5m", report.landing_um, allowed(path.max_landing_um)));
  }
  figures.push_back(judged("galvo from its centre", "mm", report.displacement_mm, allowed(path.max_displacement_mm)));
  figures.push_back(judged("spacing", "\u00b5m", report.spacing_um, figure(report.half_slot_um)));
  return figures;
}

Json axes_json(const report::PathReportData& data) {
  Json axes = Json::array();
  for (std::size_t axis = 0; axis < data.verified.axes.size(); ++axis) {
    const AxisUse& use = data.verified.axes[axis];
    const PathAxisPlan& plan = data.header->plan.path->axes[axis];
    const bool turns = kPathAxes[axis] == "A" || kPathAxes[axis] == "C";
    Json least = Json::array();
    Json most = Json::array();
    for (std::size_t i = 0; i < data.traces[axis].least.size(); ++i) {
      least.push_back(place(data.traces[axis].least[i]));
      most.push_back(place(data.traces[axis].most[i]));
    }
    axes.push_back(
        {{"name", std::string(kPathAxes[axis])},
         {"unit", turns ? "\u00b0" : "mm"},
         {"from", place(use.least)},
         {"to", place(use.most)},
         {"least_allowed", allowed(plan.least)},
         {"most_allowed", allowed(plan.most)},
         {"speed", {figure(use.max_speed), allowed(plan.limits.max_speed), figure(use.speed_rounding)}},
         {"acceleration",
          {figure(use.max_acceleration), allowed(plan.limits.max_acceleration), figure(use.acceleration_rounding)}},
         {"jerk", {figure(use.max_jerk), allowed(plan.limits.max_jerk), figure(use.jerk_rounding)}},
         {"trace", {{"least", least}, {"most", most}}}});
  }
  return axes;
}

Json map_json(const report::PulseMap& map) {
  const std::vector<double> pulses = map.pulses();
  std::vector<double> heights = map.heights();
  const double most = pulses.empty() ? 0 : *std::max_element(pulses.begin(), pulses.end());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    heights[i] = pulses[i] > 0 ? std::max(0.0, heights[i] - map.lowest_mm()) : 0;
  }
  return {{"cells", {map.cells().width, map.cells().height}},
          {"cell_mm", map.cell_mm()},
          {"left_mm", figure(map.left_mm())},
          {"bottom_mm", figure(map.bottom_mm())},
          {"lowest_mm", figure(map.lowest_mm())},
          {"highest_mm", figure(map.highest_mm())},
          {"most", most},
          {"pulses", sixteen_bits(pulses, most)},
          {"heights", sixteen_bits(heights, map.highest_mm() - map.lowest_mm())}};
}

/// The places of pulses, each axis in 16 bits from its least.
Json sample_json(const report::PulseSample& sample) {
  Json axes = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    values.reserve(sample.places_mm().size());
    for (const std::array<double, 3>& place : sample.places_mm()) {
      values.push_back(place[axis]);
    }
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double low = values.empty() ? 0 : *least;
    const double span = values.empty() ? 0 : *most - low;
    for (double& value : values) {
      value -= low;
    }
    axes.push_back({{"least_mm", figure(low)}, {"span_mm", figure(span)}, {"at", sixteen_bits(values, span)}});
  }
  return {{"every", sample.every()}, {"shown", sample.places_mm().size()}, {"axes", axes}};
}

}  // namespace

Result<std::string> path_report_json(const report::PathReportData& data) {
  const Plan& plan = data.header->plan;
  const PathPlan& path = *plan.path;
  const PathReport& verified = data.verified;
  Json sources = Json::array();
  for (const SourceImage& source : data.header->sources) {
    sources.push_back({{"path", source.path}, {"sha256", source.sha256}});
  }
  Json json = report_head(data);
  json["verdict"].update({{"pulses", verified.pulses},
                          {"fired", verified.fired},
                          {"points_compared", verified.points_compared},
                          {"bits_compared", verified.bits_compared}});
  json.update({{"job",
                {{"title", plan.title},
                 {"mode", mode_name(plan.mode)},
                 {"surface", path.surface},
                 {"texture", path.texture},
                 {"fires", data.header->fires == Fires::white ? "white" : "black"},
                 {"signs", path.machine},
                 {"pitch_um", json_of(plan.line.pixel_pitch_um)},
                 {"duration_s", json_of(plan.job.duration_s)},
                 {"ticks", std::to_string(plan.job.ticks)},
                 {"warnings", plan.warnings}}},
               {"clock",
                {{"seed_hz", plan.clock.seed_hz},
                 {"fpga_hz", plan.clock.fpga_hz},
                 {"multiplier", plan.clock.fpga_hz / plan.clock.seed_hz},
                 {"pulse_divider", plan.clock.pulse_divider},
                 {"pulse_hz", json_of(plan.clock.pulse_hz)},
                 {"ticks_per_slot", plan.clock.ticks_per_slot},
                 {"slots_per_period", plan.line.slots},
                 {"ticks_per_period", plan.line.ticks},
                 {"periods", plan.rotary.lines_per_revolution}}},
               {"figures", figures_json(verified, path)},
               {"axes", axes_json(data)},
               {"map", map_json(data.map)},
               {"sample", sample_json(data.sample)},
               {"line", line_json(data.period)},
               {"sources", sources}});
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gravure
