#include <fmt/format.h>

#include <memory>
#include <optional>

#include "program/program_files.hpp"
#include "texture/freeform_job.hpp"
#include "texture/freeform_program.hpp"
#include "texture/texture_command.hpp"

namespace gravure::cli {
namespace {

struct TextureCompileArguments {
  FreeformJob job;
  std::vector<std::string> limits;
  std::string output;
  std::string points;
};

Result<int> run_texture_compile(TextureCompileArguments options, const Command& command) {
  GRAVURE_CHECK(refuse_overwrite({{"--output", options.output, Writes::program}, {"--points", options.points}},
                                 inputs_of(options.job.texture)));
  GRAVURE_CHECK(set_limits(options.limits, options.job.motion));
  return compile_freeform_job(options.job, {options.output, options.points, {}}, command);
}

}  // namespace

void add_texture_compile(CLI::App& texture, Command& command) {
  CLI::App* verb =
      add_verb(texture, command, "compile", "Texture on a surface to program file, all seven axes in time");
  const auto options = std::make_shared<TextureCompileArguments>();
  Job& job = options->job.job;
  job.mode = Mode::freeform;
  job.title = "texture";
  job.laser.seed_hz = 82'000'000;
  job.laser.pulse_divider = 41;
  job.fpga.clock_multiplier = 2;
  add_texture_options(*verb, options->job.texture);
  add_split_options(*verb, options->job.split, "by --rule");
  add_axes_options(*verb, options->job.axes);
  add_motion_options(*verb, options->job, options->limits);
  verb->add_option("-o,--output", options->output, "Program file to write (.grv)")->required();
  add_points_option(*verb, options->points);
  add_texture_memory(*verb, command);
  verb->add_option("--title", job.title, "What the program calls itself")->capture_default_str();
  add_integer(*verb, "--seed-hz", job.laser.seed_hz, "Seed pulses a second", 1, 1'000'000'000'000);
  add_integer(*verb, "--pulse-divider", job.laser.pulse_divider, "Every so many seed pulses one is amplified", 1,
              65'535);
  add_integer(*verb, "--clock-multiplier", job.fpga.clock_multiplier, "FPGA ticks a seed pulse", 1, 16);
  add_length(*verb, "--landing-um", options->job.split.landing_um, 1e6, "Largest landing error that `verify` allows");
  set_run(*verb, command, options, run_texture_compile);
}

}  // namespace gravure::cli
