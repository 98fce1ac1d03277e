#include "texture_command.hpp"

#include <fmt/format.h>

#include <memory>

#include "gravure/kinematics/machines.hpp"
#include "gravure/texture/axes.hpp"
#include "gravure/texture/split.hpp"
#include "program_files.hpp"
#include "texture_options.hpp"

namespace gravure::cli {
namespace {

struct Options {
  TextureOptions texture;
  SplitOptions split;
  std::string points;
};

Result<texture::Split> split_of(const SplitOptions& options, const texture::Surface& surface,
                                const texture::TexturePath& path) {
  const texture::GaussianFilter filter{.sigma_mm = options.sigma_um.value_or(0) / kUmPerMm, .cut = options.cut};
  return options.sigma_um ? texture::split_path(surface, path, filter)
                          : texture::split_by_published_rule(surface, path, limits_of(options), filter, cancel_token());
}

void print_split(const Options& options, const texture::Split& split, const texture::TexturePath& path,
                 const std::vector<std::string>& violations, const Command& command) {
  if (command.json) {
    Json json = split_json(options.texture.surface, path, split);
    json["violations"] = violations;
    print_json(json);
    return;
  }
  std::string text =
      split_text(path, split, options.split,
                 options.split.sigma_um ? "" : fmt::format(", number {} from 30000 um by 0.95", split.tries - 1));
  for (const std::string& violation : violations) {
    text += "violation: " + violation + "\n";
  }
  print(text);
}

Result<int> decompose(const Options& options, const Command& command) {
  GRAVURE_CHECK(refuse_overwrite({{"--points", options.points}}, {options.texture.path}));
  GRAVURE_TRY(const std::unique_ptr<texture::Surface> surface, texture::expression_surface(options.texture.surface));
  GRAVURE_TRY(const texture::TexturePath path, path_of(options.texture));
  GRAVURE_TRY(const texture::Split split, split_of(options.split, *surface, path));
  if (!options.points.empty()) {
    const auto machine = kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, kinematics::Vector3::Zero(), {});
    GRAVURE_TRY(const std::vector<texture::SevenAxes> axes, texture::seven_axes(machine, split.targets, split.stages));
    GRAVURE_CHECK(write_points(options.points, split, axes));
  }
  const std::vector<std::string> violations = texture::violations(split.most, limits_of(options.split));
  print_split(options, split, path, violations, command);
  return violations.empty() ? kDone : kLimitViolated;
}

void add_decompose(CLI::App& texture, Command& command) {
  CLI::App* verb =
      add_verb(texture, command, "decompose", "Split a path on a surface between five stages and the galvo");
  const auto options = std::make_shared<Options>();
  add_texture_options(*verb, options->texture);
  add_split_options(*verb, options->split, "the first of 30000, 28500 ... that meets the limits");
  verb->add_option("--points", options->points, "CSV of every point, its stages' point, axes and deviations");
  verb->callback([&command, options] { command.run = [&command, options] { return decompose(*options, command); }; });
}

}  // namespace

void add_texture(CLI::App& app, Command& command) {
  CLI::App* texture =
      app.add_subcommand("texture", "Paths on freeform surfaces with five stages and the galvo at once");
  texture->require_subcommand(1);
  add_decompose(*texture, command);
}

}  // namespace gravure::cli
