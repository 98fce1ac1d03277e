#include "texture_command.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "gravure/raster/count.hpp"
#include "gravure/texture/clamping.hpp"
#include "gravure/texture/split.hpp"
#include "program_files.hpp"
#include "texture_options.hpp"
#include "texture_plan_command.hpp"

namespace gravure::cli {
namespace {

struct TextureArguments {
  TextureSettings texture;
  SplitSettings split;
  AxesSettings axes;
  std::optional<double> most_tilt_deg;
  std::string points;
};

struct Found {
  texture::TexturePath path;
  texture::Split split;
  texture::StageDemand demand;
  std::optional<PathPulses> pulses;
  std::optional<texture::ClampingAdvice> advice;
  std::vector<std::string> violations;
};

Result<texture::Split> split_of(const SplitSettings& options, const texture::Surface& surface,
                                const texture::TexturePath& path) {
  const std::unique_ptr<texture::Splitter> splitter = splitter_of(options);
  const texture::DeviationLimits limits = limits_of(options);
  return options.sigma_um
             ? texture::split_path(*splitter, surface, path, limits, *options.sigma_um / kUmPerMm, cancel_token())
             : texture::split_by_published_rule(*splitter, surface, path, limits, cancel_token());
}

std::string which_sigma(const SplitSettings& options, const texture::Split& split) {
  if (options.method == "adaptive") {
    return " at most, narrowed where limits ask for it";
  }
  return options.sigma_um ? "" : fmt::format(", number {} from 30000 um by 0.95", split.tries - 1);
}

Json advice_json(const texture::ClampingAdvice& advice) {
  const auto travel = [](const texture::CTravel& of) {
    return Json{{"c_turns", figure(of.turns)},
                {"c_rad_per_mm", figure(of.max_rate_rad_per_mm)},
                {"nearest_pole_deg", figure(of.nearest_pole_rad * kDegreesPerRad)}};
  };
  return {
      {"tilt_deg",
       {figure(advice.clamping.about_x_rad * kDegreesPerRad), figure(advice.clamping.about_y_rad * kDegreesPerRad)}},
      {"pays", advice.pays},
      {"as_it_lies", travel(advice.flat)},
      {"tilted", travel(advice.tilted)}};
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
  Json json = split_json(surface_name(options.texture), found.path, found.split);
  json["split"] = options.split.method;
  if (options.split.method == "optimal") {
    json["sigma_um"] = nullptr;
  }
  json["stages"] = {{"bend_per_mm", {{"max", figure(found.demand.max_bend_per_mm)}}},
                    {"jerk_per_mm2",
                     {{"max", figure(found.demand.max_jerk_per_mm2)}, {"rms", figure(found.demand.rms_jerk_per_mm2)}}}};
  if (found.pulses) {
    json["picture"] = {{"pixels", found.pulses->count}, {"fired_pixels", raster::popcount(found.pulses->bits)}};
  }
  if (found.advice) {
    json["clamping"] = advice_json(*found.advice);
  }
  json["violations"] = found.violations;
  print_json(json);
}

void print_text(const TextureArguments& options, const Found& found) {
  std::string text = split_text(found.path, found.split, options.split, which_sigma(options.split, found.split));
  text += fmt::format("stages        {}: bend {:.4g} /mm at most, jerk {:.4g} /mm^2 at most, {:.4g} rms\n",
                      options.split.method, found.demand.max_bend_per_mm, found.demand.max_jerk_per_mm2,
                      found.demand.rms_jerk_per_mm2);
  if (found.pulses) {
    text +=
        fmt::format("picture       {} pixels, {} fire\n", found.pulses->count, raster::popcount(found.pulses->bits));
  }
  if (found.advice) {
    text += advice_text(*found.advice);
  }
  for (const std::string& violation : found.violations) {
    text += "violation: " + violation + "\n";
  }
  print(text);
}

Result<Found> find(const TextureArguments& options) {
  Found found;
  GRAVURE_TRY(const std::unique_ptr<texture::Surface> surface, surface_of(options.texture));
  GRAVURE_TRY(found.path, path_of(options.texture));
  if (!options.texture.bitmap.empty()) {
    GRAVURE_TRY(found.pulses, picture_pulses_of(options.texture));
  }
  GRAVURE_TRY(found.split, split_of(options.split, *surface, found.path));
  found.demand = texture::stage_demand(found.split.stages, found.path.step_mm);
  if (options.most_tilt_deg) {
    GRAVURE_TRY(found.advice, texture::advise_clamping(found.split.stages, found.path.step_mm,
                                                       *options.most_tilt_deg / kDegreesPerRad, cancel_token()));
  }
  found.violations = texture::violations(found.split.most, limits_of(options.split));
  return found;
}

Result<int> decompose(const TextureArguments& options, const Command& command) {
  GRAVURE_CHECK(refuse_overwrite({{"--points", options.points}}, inputs_of(options.texture)));
  GRAVURE_TRY(const Found found, find(options));
  if (!options.points.empty()) {
    GRAVURE_TRY(const std::vector<texture::SevenAxes> axes, axes_of(options.axes, found.split));
    GRAVURE_CHECK(write_points(options.points, found.split, axes, options.split.focus_axis));
  }
  command.json ? print_found_json(options, found) : print_text(options, found);
  return found.violations.empty() ? kDone : kLimitViolated;
}

void add_decompose(CLI::App& texture, Command& command) {
  CLI::App* verb =
      add_verb(texture, command, "decompose", "Split a path on a surface between five stages and the galvo");
  const auto options = std::make_shared<TextureArguments>();
  add_texture_options(*verb, options->texture);
  add_split_options(*verb, options->split, "the first of 30000, 28500 ... that meets the limits");
  add_axes_options(*verb, options->axes);
  add_length(*verb, "--suggest-tilt", options->most_tilt_deg, 90,
             "Look for a clamping, tilted by so many degrees at most, in which C turns slower");
  verb->add_option("--points", options->points, "CSV of every point, its stages' point, axes and deviations");
  verb->callback([&command, options] { command.run = [&command, options] { return decompose(*options, command); }; });
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
