#include "zones/zones_compile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gravure/core/file_output.hpp"
#include "program/path_program.hpp"
#include "program/program_files.hpp"
#include "texture/texture_options.hpp"
#include "zones/zones_plot.hpp"
#include "zones/zones_program.hpp"

namespace gravure::cli {
namespace {

using zones::ZoneMotion;
using zones::ZonePlan;

struct CompileOptions {
  std::string job;
  std::string output;
  std::string plot;
};

double worst_incidence_rad(const ZonePlan& plan) {
  double worst = 0;
  for (const zones::PlannedZone& zone : plan.zones) {
    worst = std::max(worst, zone.zone.max_incidence_rad);
  }
  return worst;
}

double thickest_layer_mm(const ZonePlan& plan) {
  double thickest = 0;
  for (const zones::PlannedZone& zone : plan.zones) {
    thickest = std::max(thickest, zone.layer_thickness_mm);
  }
  return thickest;
}

/// Widths of a line that runs along and across the long axis of the ellipses.
struct LineWidths {
  double along_um = 0;
  double across_um = 0;
};

LineWidths widths_at(const ZonesOptics& optics, double incidence_rad) {
  // load_zones_job() has refused what ablates nothing at the job's limit, and no zone is beyond it.
  const zones::Ellipse ellipse = *zones::ablated_ellipse(optics.spot, optics.over_threshold, incidence_rad);
  constexpr double kAcross_rad = 90 / kDegreesPerRad;
  return {zones::line_width_um(ellipse, 0), zones::line_width_um(ellipse, kAcross_rad)};
}

Json optics_json(const ZonesOptics& optics, const ZonePlan& plan) {
  Json json = {{"waist_um", figure(optics.spot.waist_um)},
               {"rayleigh_mm", figure(optics.spot.rayleigh_mm)},
               {"least_fluence_share", figure(zones::fluence_fraction(optics.spot, 0, thickest_layer_mm(plan) / 2))}};
  if (optics.over_threshold > 0) {
    const LineWidths worst = widths_at(optics, worst_incidence_rad(plan));
    json["peak_fluence_j_cm2"] = figure(optics.spot.peak_fluence_j_cm2);
    json["line_width_um"] = figure(widths_at(optics, 0).along_um);
    json["line_width_at_max_incidence_um"] = {figure(worst.along_um), figure(worst.across_um)};
  }
  return json;
}

std::string optics_text(const ZonesOptics& optics, const ZonePlan& plan) {
  std::string text = fmt::format(
      "focus        waist {:.3f} um, Rayleigh length {:.4f} mm; {:.2f} % of the peak fluence "
      "half a layer off\n",
      optics.spot.waist_um, optics.spot.rayleigh_mm,
      100 * zones::fluence_fraction(optics.spot, 0, thickest_layer_mm(plan) / 2));
  if (optics.over_threshold > 0) {
    const double incidence_rad = worst_incidence_rad(plan);
    const LineWidths worst = widths_at(optics, incidence_rad);
    text += fmt::format("lines        {:.3f} um wide at normal incidence, {:.3f} to {:.3f} um at {:.4f} deg\n",
                        widths_at(optics, 0).along_um, worst.along_um, worst.across_um, incidence_rad * kDegreesPerRad);
  }
  return text;
}

void report(const CompileOptions& options, const LoadedZonesJob& loaded, const ZonePlan& plan, const ZoneMotion& motion,
            const CompiledPath& made, const Command& command) {
  const PathSpacing& spacing = made.spacing;
  const zones::ZoneTimes& times = motion.times();
  const double time_s = to_double(made.header.plan.job.duration_s);
  if (command.json) {
    Json json = {{"program", options.output},
                 {"contours", loaded.request.contours.size()},
                 {"zones", plan.zones.size()},
                 {"lower_bound", plan.lower_bound},
                 {"added_for_travel", plan.added_for_travel},
                 {"stops", times.stops},
                 {"strokes", times.strokes},
                 {"length_mm", figure(motion.length_mm())},
                 {"max_incidence_deg", figure(worst_incidence_rad(plan) * kDegreesPerRad)},
                 {"layer_mm", figure(thickest_layer_mm(plan))},
                 {"time_s", time_s},
                 {"stage_s", figure(times.stage_s)},
                 {"jump_s", figure(times.jump_s)},
                 {"mark_s", figure(times.mark_s)},
                 {"periods", made.header.plan.rotary.lines_per_revolution}};
    json.update(spacing_json(spacing));
    if (loaded.optics) {
      json["optics"] = optics_json(*loaded.optics, plan);
    }
    print_json(json);
    return;
  }
  std::string text =
      fmt::format("{}: {:.3f} s in {} periods of {} us; {} pulses on {} contours of {:.3f} mm in all\n", options.output,
                  time_s, made.header.plan.rotary.lines_per_revolution, to_decimal_string(loaded.job.servo_us),
                  spacing.fired, loaded.request.contours.size(), motion.length_mm());
  text += fmt::format("zones        {}, at least {}{}; {} stops, {} strokes; incidence {:.4f} deg at most, {}\n",
                      plan.zones.size(), plan.lower_bound, travel_text(plan), times.stops, times.strokes,
                      worst_incidence_rad(plan) * kDegreesPerRad,
                      thickest_layer_mm(plan) > 0 ? fmt::format("layers of {:.4f} mm", thickest_layer_mm(plan))
                                                  : "each flat: one layer");
  text += loaded.optics ? optics_text(*loaded.optics, plan) : "";
  text += fmt::format("time         {:.3f} s of stage moves, {:.3f} s of jumps, {:.3f} s of marks\n", times.stage_s,
                      times.jump_s, times.mark_s);
  text += "spacing      " + spacing_text(spacing) + "\n";
  print(text);
}

/// Drawn, but not in its place before the program is in its own.
Result<std::optional<FileOutput>> draw(const CompileOptions& options, const LoadedZonesJob& loaded,
                                       const ZonesProgram& laid) {
  if (options.plot.empty()) {
    return std::optional<FileOutput>();
  }
  GRAVURE_TRY(FileOutput plot, stage_file(options.plot, zones_to_svg(laid.zones, loaded.job.contours)));
  return std::optional(std::move(plot));
}

/// What no limit forbids and hardly anybody wants.
void warn_of_contours(const std::vector<Contour>& contours, double pitch_mm) {
  std::map<std::vector<std::array<double, 3>>, std::int64_t> seen;
  std::vector<std::string> too_short;
  std::vector<std::string> twice;
  for (const Contour& contour : contours) {
    if (const double length = zones::length_mm(zones::points_of(contour)); length < pitch_mm) {
      too_short.push_back(fmt::format("contour {} is {:.6g} um long", contour.id, length * kUmPerMm));
    }
    const auto [first, is_new] = seen.emplace(contour.points_mm, contour.id);
    if (!is_new) {
      twice.push_back(fmt::format("contours {} and {} are the same line", first->second, contour.id));
    }
  }
  const auto say = [](const std::vector<std::string>& found, const std::string& what) {
    if (!found.empty()) {
      const std::string others = found.size() > 1 ? fmt::format(" ({} such)", found.size()) : "";
      warn(found.front() + what + others);
    }
  };
  say(too_short,
      fmt::format(", less than [marking] pulse_pitch_um = {:.6g}: it gets one pulse or none", pitch_mm * kUmPerMm));
  say(twice, ": it is marked twice");
}

Result<int> compile_zones(const CompileOptions& options, const Command& command) {
  GRAVURE_TRY(const LoadedZonesJob loaded, load_zones_job(options.job));
  const ZonesFiles& files = loaded.files;
  GRAVURE_CHECK(refuse_overwrite({{"--output", options.output, Writes::program}, {"--plot", options.plot}},
                                 {options.job, files.contours, files.transform, files.machine}));
  GRAVURE_TRY(const ZonesProgram laid, lay_out_zones(loaded));
  GRAVURE_TRY(std::optional<FileOutput> plot, draw(options, loaded, laid));
  GRAVURE_TRY(const CompiledPath made, compile_zones_program(loaded, laid, options.output));
  if (plot) {
    GRAVURE_CHECK(plot->commit());
  }
  warn_of_contours(loaded.request.contours, to_double(loaded.job.pulse_pitch_um) / kUmPerMm);
  report(options, loaded, laid.zones, *laid.motion, made, command);
  return kDone;
}

}  // namespace

void add_zones_compile(CLI::App& zones, Command& command) {
  CLI::App* verb = add_verb(zones, command, "compile", "Zones job to program file: stage moves dark, contours marked");
  const auto options = std::make_shared<CompileOptions>();
  verb->add_option("JOB", options->job, "Zones job (TOML)")->required();
  verb->add_option("-o,--output", options->output, "Program file to write (.grv)")->required();
  verb->add_option("--plot", options->plot, "Picture of the zones as SVG");
  set_run(*verb, command, options, compile_zones);
}

}  // namespace gravure::cli
