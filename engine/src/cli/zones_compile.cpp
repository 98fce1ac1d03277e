#include "zones_compile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "gravure/core/file_output.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/pipeline/compile_path.hpp"
#include "gravure/pipeline/path_plan.hpp"
#include "gravure/zones/zone_motion.hpp"
#include "path_program.hpp"
#include "program_files.hpp"
#include "texture_options.hpp"
#include "zones_job_loader.hpp"
#include "zones_plot.hpp"

namespace gravure::cli {
namespace {

using zones::ZoneMotion;
using zones::ZonePlan;

struct CompileOptions {
  std::string job;
  std::string output;
  std::string plot;
};

/// Of a number of the machine, which was made exact once and turned into other units since.
Rational ten_digits(double value) {
  return exact_decimal(value, 10);
}

std::optional<Rational> ten_digits(const std::optional<double>& value, double unit) {
  return value ? std::optional(ten_digits(*value * unit)) : std::nullopt;
}

Result<ZonePlan> plan_within_limits(const LoadedZonesJob& loaded) {
  GRAVURE_TRY(ZonePlan plan, zones::plan_zones(loaded.request));
  if (plan.violations.empty()) {
    return plan;
  }
  std::string text = "the zones break their limits, nothing was written:";
  for (const std::string& violation : plan.violations) {
    text += "\n  " + violation;
  }
  return Error{ErrorCode::out_of_range, text};
}

PathAxisPlan stage_plan(const kinematics::Joint& joint) {
  const double unit = joint.kind == kinematics::JointKind::revolute ? kDegreesPerRad : 1;
  const kinematics::JointLimits& limits = joint.limits;
  PathAxisPlan axis;
  axis.limits = {ten_digits(limits.max_speed, unit), ten_digits(limits.max_acceleration, unit),
                 ten_digits(limits.max_jerk, unit)};
  axis.least = ten_digits(limits.least, unit);
  axis.most = ten_digits(limits.most, unit);
  return axis;
}

PathAxisPlan galvo_plan(const kinematics::ScanHead& head) {
  PathAxisPlan axis;
  axis.limits = {ten_digits(head.max_speed_mm_s, 1), ten_digits(head.max_acceleration_mm_s2, 1),
                 ten_digits(head.max_jerk_mm_s3, 1)};
  axis.most = ten_digits(head.field_mm / 2);
  axis.least = -*axis.most;
  return axis;
}

PathPlanRequest plan_request(const LoadedZonesJob& loaded) {
  const ZonesJob& job = loaded.job;
  const kinematics::Machine& machine = loaded.request.machine;
  PathPlanRequest request;
  request.title = job.title;
  request.mode = Mode::zones;
  request.laser = job.laser;
  request.clock_multiplier = job.clock_multiplier;
  request.servo_period_us = job.servo_us;
  request.pulse_pitch_um = job.pulse_pitch_um;
  PathPlan& path = request.path;
  for (std::size_t axis = 0; axis < path.axes.size(); ++axis) {
    const auto joint = std::find_if(machine.joints.begin(), machine.joints.end(),
                                    [&](const kinematics::Joint& each) { return each.name == kPathAxes[axis]; });
    path.axes[axis] = joint != machine.joints.end() ? stage_plan(*joint) : galvo_plan(machine.head);
  }
  const Rational half_layer_um(kUmPerMm / 2);
  path.max_focus_offset_um = half_layer_um * job.layer_mm.value_or(ten_digits(loaded.request.max_layer_mm));
  path.max_incidence_deg = job.max_incidence_deg;
  path.max_landing_um = job.max_landing_um;
  path.machine = loaded.machine;
  for (std::size_t i = 0; i < path.rotary_centre_mm.size(); ++i) {
    path.rotary_centre_mm[i] = ten_digits(machine.head.origin_mm[static_cast<Eigen::Index>(i)]);
  }
  path.surface = job.contours + (job.transform.empty() ? "" : ", moved by " + job.transform);
  return request;
}

/// What the job names, as sources of its program: without a size, for they are no pictures.
Result<std::vector<SourceImage>> zone_sources(const LoadedZonesJob& loaded) {
  std::vector<SourceImage> sources;
  const std::string* const names[] = {&loaded.job.contours, &loaded.job.transform, &loaded.job.machine};
  for (std::size_t i = 0; i < std::size(names); ++i) {
    if (!names[i]->empty()) {
      GRAVURE_TRY(const std::string hash, sha256_file(loaded.inputs[i + 1]));  // the first is the job itself
      sources.push_back({*names[i], 0, 0, 0, hash});
    }
  }
  return sources;
}

Result<CompiledPath> compile_motion(const CompileOptions& options, const LoadedZonesJob& loaded,
                                    const ZoneMotion& motion) {
  GRAVURE_TRY(const PathPulses pulses, all_pulses("[marking] pulse_pitch_um",
                                                  to_double(loaded.job.pulse_pitch_um) / kUmPerMm, motion.length_mm()));
  ProgramHeader header;
  GRAVURE_TRY(header.sources, zone_sources(loaded));
  header.job_text = loaded.text;
  header.job_path = relative_to(options.job, std::filesystem::path(options.output).parent_path());
  GRAVURE_TRY(header.plan, make_path_plan(plan_request(loaded), motion.instants(), pulses.count,
                                          static_cast<std::int64_t>(motion.targets().size())));
  GRAVURE_TRY(const std::unique_ptr<LineSink> sink,
              create_grv(options.output, 1, header.plan.rotary.lines_per_revolution, header.line_bytes()));
  ProgressBar bar("compile");
  return compile_path(std::move(header), motion, pulses, motion.targets(), *sink, &cancel_token(), &bar);
}

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
  text += fmt::format(
      "zones        {}, at least {}; {} stops, {} strokes; incidence {:.4f} deg at most, layers of "
      "{:.4f} mm\n",
      plan.zones.size(), plan.lower_bound, times.stops, times.strokes, worst_incidence_rad(plan) * kDegreesPerRad,
      thickest_layer_mm(plan));
  text += loaded.optics ? optics_text(*loaded.optics, plan) : "";
  text += fmt::format("time         {:.3f} s of stage moves, {:.3f} s of jumps, {:.3f} s of marks\n", times.stage_s,
                      times.jump_s, times.mark_s);
  text += "spacing      " + spacing_text(spacing) + "\n";
  print(text);
}

Result<int> compile_zones(const CompileOptions& options, const Command& command) {
  GRAVURE_TRY(const LoadedZonesJob loaded, load_zones_job(options.job));
  GRAVURE_CHECK(refuse_overwrite({{"--output", options.output}, {"--plot", options.plot}}, loaded.inputs));
  GRAVURE_TRY(const ZonePlan plan, plan_within_limits(loaded));
  constexpr double kUsPerS = 1e6;
  zones::ZoneMotionRequest request;
  request.servo_period_s = to_double(loaded.job.servo_us) / kUsPerS;
  request.mark_speed_mm_s = to_double(loaded.job.mark_speed_mm_s);
  if (loaded.job.jump_speed_mm_s) {
    request.jump_speed_mm_s = to_double(*loaded.job.jump_speed_mm_s);
  }
  GRAVURE_TRY(const std::unique_ptr<ZoneMotion> motion, ZoneMotion::create(plan, loaded.request.machine, request));
  GRAVURE_TRY(const CompiledPath made, compile_motion(options, loaded, *motion));
  if (!options.plot.empty()) {
    GRAVURE_CHECK(write_whole(options.plot, zones_to_svg(plan, loaded.job.contours)));
  }
  report(options, loaded, plan, *motion, made, command);
  return kDone;
}

}  // namespace

void add_zones_compile(CLI::App& zones, Command& command) {
  CLI::App* verb = add_verb(zones, command, "compile", "Zones job to program file: stage moves dark, contours marked");
  const auto options = std::make_shared<CompileOptions>();
  verb->add_option("JOB", options->job, "Zones job (TOML)")->required();
  verb->add_option("-o,--output", options->output, "Program file to write (.grv)")->required();
  verb->add_option("--plot", options->plot, "Picture of the zones as SVG");
  verb->callback(
      [&command, options] { command.run = [&command, options] { return compile_zones(*options, command); }; });
}

}  // namespace gravure::cli
