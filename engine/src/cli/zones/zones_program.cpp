#include "zones/zones_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/pipeline/path_plan.hpp"
#include "placed_error.hpp"
#include "program/path_program.hpp"
#include "program/program_files.hpp"
#include "texture/texture_options.hpp"

namespace gravure::cli {
namespace {

using zones::ZoneMotion;
using zones::ZonePlan;

/// Of a number of the machine, which was made exact once and turned into other units since.
Rational ten_digits(double value) {
  return exact_decimal(value, 10);
}

std::optional<Rational> ten_digits(const std::optional<double>& value, double unit) {
  return value ? std::optional(ten_digits(*value * unit)) : std::nullopt;
}

Result<ZonePlan> plan_within_limits(const LoadedZonesJob& loaded) {
  zones::ZonePlanRequest request = loaded.request;
  ProgressBar bar("plan zones", "steps");
  request.watch = {&cancel_token(), &bar};
  GRAVURE_TRY(ZonePlan plan, zones::plan_zones(request));
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
  request.title = job.job.title;
  request.mode = Mode::zones;
  request.laser = job.job.laser;
  request.clock_multiplier = job.job.fpga.clock_multiplier;
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
  const ZonesJob& job = loaded.job;
  const ZonesFiles& files = loaded.files;
  for (const auto& [name, place] : {std::pair(job.contours, files.contours), std::pair(job.transform, files.transform),
                                    std::pair(job.machine, files.machine)}) {
    if (!name.empty()) {
      GRAVURE_TRY(const std::string hash, sha256_file(place));
      sources.push_back({name, 0, 0, 0, hash});
    }
  }
  return sources;
}

zones::ZoneMotionRequest motion_request(const ZonesJob& job) {
  constexpr double kUsInS = 1e6;
  zones::ZoneMotionRequest request;
  request.servo_period_s = to_double(job.servo_us) / kUsInS;
  request.mark_speed_mm_s = to_double(job.mark_speed_mm_s);
  if (job.jump_speed_mm_s) {
    request.jump_speed_mm_s = to_double(*job.jump_speed_mm_s);
  }
  return request;
}

}  // namespace

Result<ZonesProgram> lay_out_zones(const LoadedZonesJob& loaded) {
  const Job& job = loaded.job.job;
  ZonesProgram made;
  GRAVURE_TRY(made.zones, placed(job, "zones", plan_within_limits(loaded)));
  GRAVURE_TRY(made.motion, placed(job, "marking",
                                  ZoneMotion::create(made.zones, loaded.request.machine, motion_request(loaded.job))));
  GRAVURE_TRY(made.pulses,
              placed(job, "marking.pulse_pitch_um",
                     all_pulses("[marking] pulse_pitch_um", to_double(loaded.job.pulse_pitch_um) / kUmPerMm,
                                made.motion->length_mm())));
  GRAVURE_TRY(made.plan, placed(job, "marking",
                                make_path_plan(plan_request(loaded), made.motion->instants(), made.pulses.count,
                                               static_cast<std::int64_t>(made.motion->targets().size()))));
  return made;
}

std::string travel_text(const ZonePlan& plan) {
  return plan.added_for_travel == 0
             ? ""
             : fmt::format(", and {} more for contours that are within travel only apart", plan.added_for_travel);
}

Result<CompiledPath> compile_zones_program(const LoadedZonesJob& loaded, const ZonesProgram& made,
                                           const std::string& output) {
  ProgramHeader header;
  header.plan = made.plan;
  header.job_text = loaded.job.job.text;
  header.job_path = relative_to(loaded.job.job.path, std::filesystem::path(output).parent_path());
  GRAVURE_TRY(header.sources, zone_sources(loaded));
  GRAVURE_TRY(const std::unique_ptr<LineSink> sink,
              create_grv(output, 1, header.plan.rotary.lines_per_revolution, header.line_bytes()));
  ProgressBar bar("compile");
  return compile_path(std::move(header), *made.motion, made.pulses, made.motion->targets(), *sink, &cancel_token(),
                      &bar);
}

}  // namespace gravure::cli
