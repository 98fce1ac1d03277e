#include "texture/texture_command.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "gravure/raster/count.hpp"
#include "gravure/texture/clamping.hpp"
#include "program/program_files.hpp"
#include "texture/texture_outcome.hpp"
#include "texture/texture_plan_command.hpp"

namespace gravure::cli {
namespace {

struct TextureArguments {
  FreeformJob job;
  std::vector<std::string> limits;
  bool untimed = false;
  std::optional<double> most_tilt_deg;
  std::string points;
};

struct Found {
  TextureOutcome outcome;  ///< without --untimed; with it, path, split and their violations alone
  texture::StageDemand demand;
  std::optional<PathPulses> pulses;
  std::optional<texture::ClampingAdvice> advice;
  const texture::TexturePath& path() const { return outcome.seven.path; }
  const texture::Split& split() const { return outcome.seven.timed.split; }
};

Result<TextureOutcome> untimed_outcome(const FreeformJob& job, const Command& command) {
  const std::unique_ptr<texture::Splitter> splitter = splitter_of(job.split);
  if (!job.split.sigma_um && job.split.rule == "time" && !splitter->keeps_limits()) {
    return Error{ErrorCode::bad_argument,
                 "--untimed: the sigma of --rule time is found by timing; give --sigma-um or --rule published"};
  }
  TextureOutcome outcome;
  GRAVURE_TRY(outcome.seven, untimed_texture(job, command));
  outcome.violations = texture::violations(outcome.seven.timed.split.most, limits_of(job.split));
  return outcome;
}

std::string advice_text(const texture::ClampingAdvice& advice) {
  const auto travel = [](const texture::CTravel& of) {
    return fmt::format("{:.4g} turns of C, {:.4g} rad a mm at most", of.turns, of.max_rate_rad_per_mm);
  };
  std::string text = "clamping      as it lies: " + travel(advice.flat) + "\n";
  return text + (advice.pays ? fmt::format("              --tilt-deg {:.4g} {:.4g}: {}\n",
                                           advice.clamping.about_x_rad * kDegreesPerRad,
                                           advice.clamping.about_y_rad * kDegreesPerRad, travel(advice.tilted))
                             : std::string("              no tilt pays\n"));
}

void print_found_json(const TextureArguments& options, const Found& found) {
  Json json = options.untimed
                  ? split_json(surface_name(options.job.texture), found.path(), found.split(), options.job.split)
                  : outcome_json(options.job, found.outcome);
  json["stages"] = {{"bend_per_mm", {{"max", figure(found.demand.max_bend_per_mm)}}},
                    {"jerk_per_mm2",
                     {{"max", figure(found.demand.max_jerk_per_mm2)}, {"rms", figure(found.demand.rms_jerk_per_mm2)}}}};
  if (found.pulses) {
    json["picture"] = {{"pixels", found.pulses->count}, {"fired_pixels", raster::popcount(found.pulses->bits)}};
  }
  if (found.advice) {
    json["clamping"] = clamping_json(*found.advice);
  }
  json["violations"] = found.outcome.violations;
  print_json(json);
}

void print_text(const TextureArguments& options, const Found& found) {
  const SplitSettings& split = options.job.split;
  std::string text = split_text(found.path(), found.split(), split, how_sigma(split, found.outcome.seven.timed));
  text +=
      fmt::format("stages        {}: bend {:.4g} /mm at most, jerk {:.4g} /mm^2 at most, {:.4g} rms\n", split.method,
                  found.demand.max_bend_per_mm, found.demand.max_jerk_per_mm2, found.demand.rms_jerk_per_mm2);
  if (found.pulses) {
    text +=
        fmt::format("picture       {} pixels, {} fire\n", found.pulses->count, raster::popcount(found.pulses->bits));
  }
  text += options.untimed ? "" : times_text(found.outcome) + limits_text(options.job.motion, found.outcome.seven);
  text += found.advice ? advice_text(*found.advice) : "";
  print(text + violations_text(found.outcome.violations));
}

Result<Found> find(const TextureArguments& options, const Command& command) {
  Found found;
  GRAVURE_TRY(found.outcome,
              options.untimed ? untimed_outcome(options.job, command) : outcome_of(options.job, Depth::times, command));
  if (!options.job.texture.bitmap.empty()) {
    GRAVURE_TRY(found.pulses, picture_pulses_of(options.job.texture));
  }
  found.demand = texture::stage_demand(found.split().stages, found.path().step_mm);
  if (options.most_tilt_deg) {
    GRAVURE_TRY(found.advice, texture::advise_clamping(found.split().stages, found.path().step_mm,
                                                       *options.most_tilt_deg / kDegreesPerRad, cancel_token()));
  }
  return found;
}

Result<int> decompose(TextureArguments options, const Command& command) {
  GRAVURE_CHECK(refuse_overwrite({{"--points", options.points}}, inputs_of(options.job.texture)));
  GRAVURE_CHECK(set_limits(options.limits, options.job.motion));
  GRAVURE_TRY(const Found found, find(options, command));
  if (!options.points.empty()) {
    GRAVURE_TRY(const std::vector<texture::SevenAxes> axes, axes_of(options.job.axes, found.split()));
    GRAVURE_TRY(std::optional<TextOutput> points,
                stage_points(options.points, found.split(), axes, options.job.split.focus_axis));
    GRAVURE_CHECK(points->commit());
  }
  command.json ? print_found_json(options, found) : print_text(options, found);
  return found.outcome.violations.empty() ? kDone : kLimitViolated;
}

void add_decompose(CLI::App& texture, Command& command) {
  CLI::App* verb =
      add_verb(texture, command, "decompose", "Split a path on a surface between five stages and the galvo");
  const auto options = std::make_shared<TextureArguments>();
  add_texture_options(*verb, options->job.texture);
  add_split_options(*verb, options->job.split, "by --rule");
  add_axes_options(*verb, options->job.axes);
  add_motion_options(*verb, options->job, options->limits);
  verb->add_flag("--untimed", options->untimed, "The split alone, without times and limits of the axes");
  add_length(*verb, "--suggest-tilt", options->most_tilt_deg, 90,
             "Look for a clamping, tilted by so many degrees at most, in which C turns slower");
  add_points_option(*verb, options->points);
  add_texture_memory(*verb, command);
  set_run(*verb, command, options, decompose);
}

}  // namespace

void add_texture(CLI::App& app, Command& command) {
  CLI::App* texture =
      app.add_subcommand("texture", "Paths on freeform surfaces with five stages and the galvo at once");
  texture->require_subcommand(1);
  add_decompose(*texture, command);
  add_texture_plan(*texture, command);
  add_texture_compile(*texture, command);
}

}  // namespace gravure::cli
