#include "texture/texture_plan_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "program/path_program.hpp"
#include "program/program_files.hpp"
#include "texture/texture_outcome.hpp"

namespace gravure::cli {
namespace {

struct TexturePlanArguments {
  FreeformJob job;
  std::vector<std::string> limits;
  std::vector<std::string> servos;
  std::string points;
  std::string trajectory;
  std::int64_t every = 20;
};

Result<std::optional<TextOutput>> stage_trajectory(const TexturePlanArguments& options, const PathMotion& motion) {
  constexpr std::int64_t kBlock = 16'384;
  if (options.trajectory.empty()) {
    return std::optional<TextOutput>();
  }
  GRAVURE_TRY(TextOutput output, TextOutput::create(options.trajectory));
  output.text() += options.job.split.focus_axis ? "t_s,X,Y,Z,A,C,U,V,W,along_mm\n" : "t_s,X,Y,Z,A,C,U,V,along_mm\n";
  const std::size_t axes = options.job.split.focus_axis ? kPathAxes.size() : kFocusAxis;
  std::vector<PathInstant> block;
  const std::int64_t instants = motion.instants();
  for (std::int64_t first = 0; first < instants && !cancel_token().cancelled(); first += kBlock) {
    block.resize(static_cast<std::size_t>(std::min(kBlock, instants - first)));
    GRAVURE_CHECK(motion.read(first, block));
    for (std::size_t k = 0; k < block.size(); ++k) {
      const std::int64_t at = first + static_cast<std::int64_t>(k);
      if (at % options.every == 0 || at + 1 == instants) {
        output.text() += fmt::format("{:.7f}", static_cast<double>(at) * options.job.motion.servo_us / kUsPerS);
        for (std::size_t axis = 0; axis < axes; ++axis) {
          const int decimals = axis_turns(axis) ? 12 : 9;
          output.text() += fmt::format(",{:.{}f}", rounded(block[k].axes[axis], decimals), decimals);
        }
        output.text() += fmt::format(",{:.9f}\n", block[k].along_mm);
      }
    }
    if (!output.flush(false)) {
      break;
    }
  }
  return staged(std::move(output));
}

Result<int> plan(TexturePlanArguments options, const Command& command) {
  GRAVURE_CHECK(refuse_overwrite({{"--points", options.points}, {"--trajectory", options.trajectory}},
                                 inputs_of(options.job.texture)));
  GRAVURE_CHECK(set_limits(options.limits, options.job.motion));
  GRAVURE_CHECK(set_servos(options.servos, options.job.motion));
  GRAVURE_TRY(const TextureOutcome outcome, outcome_of(options.job, Depth::choice, command));
  GRAVURE_TRY(std::optional<TextOutput> points, stage_points(options.points, outcome.seven.timed.split,
                                                             outcome.seven.timed.axes, options.job.split.focus_axis));
  GRAVURE_TRY(std::optional<TextOutput> trajectory, stage_trajectory(options, *outcome.seven.proven.path.motion));
  std::vector<TextOutput> files;
  for (std::optional<TextOutput>* const output : {&points, &trajectory}) {
    if (*output) {
      files.push_back(std::move(**output));
    }
  }
  GRAVURE_CHECK(commit_together(std::move(files)));
  command.json ? print_json(outcome_json(options.job, outcome)) : print(outcome_text(options.job, outcome));
  return outcome.violations.empty() ? kDone : kLimitViolated;
}

}  // namespace

void add_texture_plan(CLI::App& texture, Command& command) {
  CLI::App* verb = add_verb(texture, command, "plan", "Time a path on a surface under the limits of all seven axes");
  const auto options = std::make_shared<TexturePlanArguments>();
  add_texture_options(*verb, options->job.texture);
  add_split_options(*verb, options->job.split, "by --rule");
  add_axes_options(*verb, options->job.axes);
  add_motion_options(*verb, options->job, options->limits);
  add_servo_option(*verb, options->servos);
  add_points_option(*verb, options->points);
  add_texture_memory(*verb, command);
  verb->add_option("--trajectory", options->trajectory, "CSV of the set-points of all axes over time");
  add_integer(*verb, "--every", options->every, "Every how many servo periods --trajectory has a line", 1,
              1'000'000'000);
  set_run(*verb, command, options, plan);
}

}  // namespace gravure::cli
