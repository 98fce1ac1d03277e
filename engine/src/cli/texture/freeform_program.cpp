#include "texture/freeform_program.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "gravure/formats/image_files.hpp"
#include "gravure/pipeline/path_plan.hpp"
#include "program/path_program.hpp"
#include "program/program_files.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

bool is_level(const AxesSettings& axes) {
  return axes.tilt_deg == std::vector<double>{0, 0};
}

Result<void> check_programmable(const FreeformJob& job) {
  if (!job.texture.pitch_um) {
    return Error{ErrorCode::bad_argument, "--pitch-um is missing: how far apart the pulses lie along the path"};
  }
  if (!is_level(job.axes) && !job.texture.bitmap.empty()) {
    return Error{ErrorCode::bad_argument,
                 "--tilt-deg, [clamping] tilt_deg: a program of a picture is made of a workpiece that lies level, for "
                 "`unroll` sees it along z"};
  }
  return {};
}

PathAxisPlan axis_plan(std::size_t axis, const texture::AxisBounds& bounds) {
  // Degrees have been rad: to ten digits they are what was given.
  const auto number = [turns = axis_turns(axis)](double value) {
    return turns ? exact_decimal(value * kDegreesPerRad, 10) : exact_decimal(value);
  };
  PathAxisPlan plan;
  plan.limits = {number(bounds.speed), number(bounds.acceleration), number(bounds.jerk)};
  return plan;
}

PathPlan path_plan_of(const FreeformJob& job, const WantedTexture& wanted) {
  PathPlan path;
  const texture::AxesLimits limits = axes_limits_of(job);
  path.axes.resize(limits.size());
  for (std::size_t axis = 0; axis < limits.size(); ++axis) {
    path.axes[axis] = axis_plan(axis, limits[axis]);
  }
  const Rational reach = exact_decimal(job.split.displacement_mm);
  for (const std::size_t axis : {5U, 6U}) {
    path.axes[axis].least = -reach;
    path.axes[axis].most = reach;
  }
  if (job.split.focus_mm) {
    const Rational focus = exact_decimal(*job.split.focus_mm);
    path.axes[kFocusAxis].least = -focus;
    path.axes[kFocusAxis].most = focus;
  }
  path.max_focus_offset_um = exact_decimal(job.split.fod_um);
  path.max_incidence_deg = exact_decimal(job.split.bia_deg);
  path.max_displacement_mm = reach;
  if (job.split.landing_um) {
    path.max_landing_um = exact_decimal(*job.split.landing_um);
  }
  path.machine = job.axes.signs == "texturing" ? "texturing" : "post_processor";
  for (std::size_t i = 0; i < 3; ++i) {
    path.rotary_centre_mm[i] = exact_decimal(job.axes.origin_mm[i]);
  }
  path.surface = surface_name(job.texture);
  if (!is_level(job.axes)) {
    path.surface += fmt::format(", tilted by {:.6g} and {:.6g} deg", job.axes.tilt_deg[0], job.axes.tilt_deg[1]);
  }
  path.texture = texture_name(job.texture);
  if (wanted.picture) {
    path.picture = PathPicture{wanted.picture->columns, wanted.picture->rows};
  }
  return path;
}

/// The files of a job as sources of its program, by the names that the job gives them.
Result<std::vector<SourceImage>> sources_of(const FreeformJob& job, const WantedTexture& wanted) {
  std::vector<SourceImage> sources;
  TextureSettings settings = job.texture;
  const std::vector<std::string> places = inputs_of(settings);
  const std::vector<std::string*> names = files_of(settings);
  for (std::size_t i = 0; i < names.size(); ++i) {
    GRAVURE_TRY(const std::string hash, sha256_file(places[i]));
    const bool is_picture = names[i] == &settings.bitmap && wanted.picture;
    sources.push_back(
        {*names[i], 0, is_picture ? wanted.picture->columns : 0, is_picture ? wanted.picture->rows : 0, hash});
  }
  return sources;
}

}  // namespace

Result<WantedTexture> wanted_of(const FreeformJob& job, const texture::TexturePath& path,
                                std::span<const texture::SurfacePoint> on_surface,
                                std::span<const texture::SurfacePoint> lying) {
  GRAVURE_CHECK(check_programmable(job));
  WantedTexture wanted;
  const std::vector<double> along_mm = texture::pulse_lengths_mm(path, on_surface);
  for (std::size_t i = 0; i < along_mm.size(); ++i) {
    const auto& p = lying[i].position_mm;
    const auto& n = lying[i].normal;
    wanted.targets.push_back({along_mm[i], {p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
  }
  if (job.texture.bitmap.empty()) {
    GRAVURE_TRY(wanted.pulses,
                placed(job, "texture", all_pulses("pitch_um", *job.texture.pitch_um / kUmPerMm, along_mm.back())));
  } else {
    GRAVURE_TRY(wanted.picture, placed(job, "texture.bitmap", picture_grid_of(job.texture)));
    GRAVURE_TRY(wanted.pulses, placed(job, "texture.bitmap", picture_pulses_of(job.texture)));
  }
  return wanted;
}

Result<WantedTexture> wanted_of(const FreeformJob& job) {
  GRAVURE_TRY(const std::unique_ptr<texture::Surface> surface, placed(job, "surface", surface_of(job.texture)));
  GRAVURE_TRY(const texture::TexturePath path, placed(job, "texture", path_of(job.texture)));
  texture::Split split;
  split.targets.resize(path.points_mm.size());
  GRAVURE_CHECK(placed(job, "surface", surface->project(path.points_mm, split.targets)));
  if (is_level(job.axes)) {
    return wanted_of(job, path, split.targets, split.targets);
  }
  const texture::Split lying = texture::clamped(split, clamping_of(job.axes));
  return wanted_of(job, path, split.targets, lying.targets);
}

Result<Plan> plan_of(const FreeformJob& job, const WantedTexture& wanted, std::int64_t instants) {
  PathPlanRequest request;
  request.title = job.job.title;
  request.laser = job.job.laser;
  request.clock_multiplier = job.job.fpga.clock_multiplier;
  request.servo_period_us = exact_decimal(job.motion.servo_us);
  request.pulse_pitch_um = exact_decimal(*job.texture.pitch_um);
  request.path = path_plan_of(job, wanted);
  GRAVURE_TRY(Plan plan,
              make_path_plan(request, instants, wanted.pulses.count, static_cast<std::int64_t>(wanted.targets.size())));
  if (wanted.picture) {
    plan.rotary.line_pitch_um = exact_decimal(wanted.picture->line_mm * kUmPerMm);
  }
  return plan;
}

Result<PlannedTexture> plan_texture(const FreeformJob& job, Depth depth, const Command& command) {
  GRAVURE_CHECK(check_programmable(job));
  PlannedTexture planned;
  GRAVURE_TRY(planned.outcome, outcome_of(job, depth, command));
  const TimedTexture& seven = planned.outcome.seven;
  GRAVURE_TRY(planned.wanted, wanted_of(job, seven.path, seven.timed.split.targets, seven.timed.targets()));
  GRAVURE_TRY(planned.plan, placed(job, "motion", plan_of(job, planned.wanted, seven.proven.path.motion->instants())));
  return planned;
}

Result<CompiledPath> compile_texture(const FreeformJob& job, const PlannedTexture& planned, const std::string& output,
                                     const GrvOptions& grv) {
  ProgramHeader header;
  header.plan = planned.plan;
  header.fires = job.texture.fires == "black" ? Fires::black : Fires::white;
  if (!job.job.text.empty()) {
    header.job_text = job.job.text;
    header.job_path = relative_to(job.job.path, fs::path(output).parent_path());
    GRAVURE_TRY(header.sources, sources_of(job, planned.wanted));
  }
  GrvOptions stored = grv;
  stored.focus_axis = header.plan.path->has_focus_axis();
  GRAVURE_TRY(const std::unique_ptr<LineSink> sink,
              create_grv(output, 1, header.plan.rotary.lines_per_revolution, header.line_bytes(), stored));
  ProgressBar bar("compile");
  return compile_path(std::move(header), *planned.outcome.seven.proven.path.motion, planned.wanted.pulses,
                      planned.wanted.targets, *sink, &cancel_token(), &bar);
}

}  // namespace gravure::cli
