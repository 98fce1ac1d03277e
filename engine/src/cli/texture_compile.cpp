#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "gravure/formats/grv.hpp"
#include "gravure/kinematics/machines.hpp"
#include "gravure/pipeline/compile_path.hpp"
#include "gravure/pipeline/path_plan.hpp"
#include "gravure/texture/path_timing.hpp"
#include "program_files.hpp"
#include "texture_command.hpp"
#include "texture_options.hpp"

namespace gravure::cli {
namespace {

struct Options {
  TextureOptions texture;
  SplitOptions split;
  AxesOptions axes;
  std::string output;
  std::string title = "texture";
  std::int64_t seed_hz = 82'000'000;
  std::int64_t pulse_divider = 41;
  std::int64_t clock_multiplier = 2;
  double servo_us = 50;
  std::optional<double> landing_um;
};

/// The number as it was given, or to ten digits.
Rational exact(double value) {
  return parse_decimal(fmt::format("{:.10g}", value)).value();
}

struct Wanted {
  texture::TexturePath path;
  texture::Split split;
  std::vector<double> along_mm;
  PathPulses pulses;
  std::optional<texture::PictureGrid> picture;
};

PathPulses all_pulses(double pitch_mm, double length_mm) {
  const auto count = static_cast<std::int64_t>(std::floor(length_mm / pitch_mm + 0.5));
  return {pitch_mm, count, std::vector<std::byte>(static_cast<std::size_t>((count + 7) / 8), std::byte{0xFF})};
}

Result<texture::Split> split_of(const SplitOptions& options, const texture::Surface& surface,
                                const texture::TexturePath& path) {
  const std::unique_ptr<texture::Splitter> splitter = splitter_of(options);
  const texture::DeviationLimits limits = limits_of(options);
  return options.sigma_um
             ? texture::split_path(*splitter, surface, path, limits, *options.sigma_um / kUmPerMm, cancel_token())
             : texture::split_by_published_rule(*splitter, surface, path, limits, cancel_token());
}

Result<Wanted> wanted_of(const Options& options) {
  if (!options.texture.pitch_um) {
    return Error{ErrorCode::bad_argument, "--pitch-um is missing: how far apart the pulses lie along the path"};
  }
  if (options.axes.tilt_deg != std::vector<double>{0, 0} || options.split.focus_axis) {
    return Error{ErrorCode::bad_argument,
                 "--tilt-deg, --focus-axis: programs are made of workpieces that lie level, for seven axes"};
  }
  Wanted wanted;
  GRAVURE_TRY(const std::unique_ptr<texture::Surface> surface, surface_of(options.texture));
  GRAVURE_TRY(wanted.path, path_of(options.texture));
  GRAVURE_TRY(wanted.split, split_of(options.split, *surface, wanted.path));
  wanted.along_mm = texture::pulse_lengths_mm(wanted.path, wanted.split.targets);
  if (options.texture.bitmap.empty()) {
    wanted.pulses = all_pulses(*options.texture.pitch_um / kUmPerMm, wanted.along_mm.back());
  } else {
    GRAVURE_TRY(wanted.picture, picture_grid_of(options.texture));
    GRAVURE_TRY(wanted.pulses, picture_pulses_of(options.texture));
  }
  return wanted;
}

PathAxisPlan axis_plan(std::size_t axis, const texture::AxisBounds& bounds) {
  const bool turns = kPathAxes[axis] == "A" || kPathAxes[axis] == "C";
  const double unit = turns ? kDegreesPerRad : 1;
  PathAxisPlan plan;
  plan.limits = {exact(bounds.speed * unit), exact(bounds.acceleration * unit), exact(bounds.jerk * unit)};
  return plan;
}

PathPlanRequest plan_request(const Options& options, const texture::SevenLimits& limits, const Wanted& wanted) {
  PathPlanRequest request;
  request.title = options.title;
  request.laser.seed_hz = options.seed_hz;
  request.laser.pulse_divider = options.pulse_divider;
  request.clock_multiplier = options.clock_multiplier;
  request.servo_period_us = exact(options.servo_us);
  request.pulse_pitch_um = exact(*options.texture.pitch_um);
  PathPlan& path = request.path;
  for (std::size_t axis = 0; axis < limits.size(); ++axis) {
    path.axes[axis] = axis_plan(axis, limits[axis]);
  }
  const Rational reach = exact(options.split.displacement_mm);
  for (const std::size_t axis : {5U, 6U}) {
    path.axes[axis].least = -reach;
    path.axes[axis].most = reach;
  }
  path.max_focus_offset_um = exact(options.split.fod_um);
  path.max_incidence_deg = exact(options.split.bia_deg);
  path.max_displacement_mm = reach;
  if (options.landing_um) {
    path.max_landing_um = exact(*options.landing_um);
  }
  path.machine = options.axes.signs == "texturing" ? "texturing" : "post_processor";
  for (std::size_t i = 0; i < 3; ++i) {
    path.rotary_centre_mm[i] = exact(options.axes.origin_mm[i]);
  }
  path.surface = surface_name(options.texture);
  if (wanted.picture) {
    path.picture = PathPicture{wanted.picture->columns, wanted.picture->rows};
    path.texture = options.texture.bitmap;
  } else {
    path.texture = options.texture.path.empty()
                       ? fmt::format("Hilbert curve of order {}", options.texture.hilbert_order)
                       : options.texture.path;
  }
  return request;
}

std::vector<PathTarget> targets_of(const Wanted& wanted) {
  std::vector<PathTarget> targets;
  for (std::size_t i = 0; i < wanted.along_mm.size(); ++i) {
    const auto& p = wanted.split.targets[i].position_mm;
    const auto& n = wanted.split.targets[i].normal;
    targets.push_back({wanted.along_mm[i], {p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
  }
  return targets;
}

Result<texture::ProvenPath> motion_of(const Options& options, const Wanted& wanted,
                                      const std::vector<texture::SevenAxes>& axes, const texture::SevenLimits& limits) {
  const auto signs =
      options.axes.signs == "texturing" ? kinematics::XyzacSigns::texturing : kinematics::XyzacSigns::post_processor;
  const kinematics::Vector3 origin_mm(options.axes.origin_mm[0], options.axes.origin_mm[1], options.axes.origin_mm[2]);
  GRAVURE_TRY(const texture::RotaryTable table, texture::rotary_table(kinematics::xyzac_machine(signs, origin_mm, {})));
  constexpr double kUsPerS = 1e6;
  texture::PathTimingRequest request{.targets = wanted.split.targets,
                                     .axes = axes,
                                     .pulse_mm = wanted.along_mm,
                                     .table = table,
                                     .limits = limits,
                                     .servo_s = options.servo_us / kUsPerS,
                                     .sigma_points = wanted.split.sigma_mm / wanted.path.step_mm};
  return texture::prove_seven_axes(request, cancel_token());
}

Result<CompiledPath> compile_to(const Options& options, const PathPlanRequest& request, const PathMotion& motion,
                                const Wanted& wanted) {
  const std::vector<PathTarget> targets = targets_of(wanted);
  ProgramHeader header;
  header.fires = options.texture.fires == "black" ? Fires::black : Fires::white;
  GRAVURE_TRY(header.plan, make_path_plan(request, motion.instants(), wanted.pulses.count,
                                          static_cast<std::int64_t>(targets.size())));
  if (wanted.picture) {
    header.plan.rotary.line_pitch_um = exact(wanted.picture->line_mm * kUmPerMm);
  }
  GRAVURE_TRY(const std::unique_ptr<LineSink> sink,
              create_grv(options.output, 1, header.plan.rotary.lines_per_revolution, header.line_bytes()));
  ProgressBar bar("compile");
  return compile_path(std::move(header), motion, wanted.pulses, targets, *sink, &cancel_token(), &bar);
}

void report(const Options& options, const CompiledPath& made, const texture::ProvenPath& proven,
            const Command& command) {
  const PathSpacing& spacing = made.spacing;
  const Plan& plan = made.header.plan;
  if (command.json) {
    print_json({{"program", options.output},
                {"time_s", to_double(plan.job.duration_s)},
                {"periods", plan.rotary.lines_per_revolution},
                {"proofs", proven.proofs},
                {"pulses", spacing.pulses},
                {"fired_pulses", spacing.fired},
                {"spacing_um", {{"max", spacing.max_error_um}, {"rms", spacing.rms_error_um}}},
                {"half_slot_um", spacing.half_slot_um},
                {"max_speed_mm_s", spacing.max_speed_mm_s},
                {"least_slots", spacing.least_slots}});
    return;
  }
  print(fmt::format(
      "{}: {:.3f} s in {} periods of {} us; {} of {} pulses fire\n"
      "spacing: {:.4g} um off at most, {:.4g} rms, half a slot {:.4g}; spot at most {:.4g} mm/s\n",
      options.output, to_double(plan.job.duration_s), plan.rotary.lines_per_revolution, options.servo_us, spacing.fired,
      spacing.pulses, spacing.max_error_um, spacing.rms_error_um, spacing.half_slot_um, spacing.max_speed_mm_s));
}

Result<int> run(const Options& options, const Command& command) {
  GRAVURE_CHECK(refuse_overwrite(options.output, inputs_of(options.texture)));
  GRAVURE_TRY(const Wanted wanted, wanted_of(options));
  GRAVURE_TRY(const std::vector<texture::SevenAxes> axes, axes_of(options.axes, wanted.split));
  const texture::SevenLimits limits = texture::published_limits();
  GRAVURE_TRY(const texture::ProvenPath proven, motion_of(options, wanted, axes, limits));
  GRAVURE_TRY(const CompiledPath made,
              compile_to(options, plan_request(options, limits, wanted), *proven.path.motion, wanted));
  report(options, made, proven, command);
  return kDone;
}

}  // namespace

void add_texture_compile(CLI::App& texture, Command& command) {
  CLI::App* verb =
      add_verb(texture, command, "compile", "Texture on a surface to program file, all seven axes in time");
  const auto options = std::make_shared<Options>();
  add_texture_options(*verb, options->texture);
  add_split_options(*verb, options->split, "the first of 30000, 28500 ... that meets the limits");
  add_axes_options(*verb, options->axes);
  verb->add_option("-o,--output", options->output, "Program file to write (.grv)")->required();
  verb->add_option("--title", options->title, "What the program calls itself")->capture_default_str();
  verb->add_option("--seed-hz", options->seed_hz, "Seed pulses a second")
      ->check(integer_from(1, 1'000'000'000'000))
      ->capture_default_str();
  verb->add_option("--pulse-divider", options->pulse_divider, "Every so many seed pulses one is amplified")
      ->check(integer_from(1, 65'535))
      ->capture_default_str();
  verb->add_option("--clock-multiplier", options->clock_multiplier, "FPGA ticks a seed pulse")
      ->check(integer_from(1, 16))
      ->capture_default_str();
  add_length(*verb, "--servo-us", options->servo_us, 1e6, "Period of the servo: a whole number of pulse slots")
      ->capture_default_str();
  add_length(*verb, "--landing-um", options->landing_um, 1e6, "Largest landing error that `verify` allows");
  verb->callback([&command, options] { command.run = [&command, options] { return run(*options, command); }; });
}

}  // namespace gravure::cli
