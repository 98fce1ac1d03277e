#include "texture_plan_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "program_files.hpp"
#include "texture_following.hpp"
#include "texture_motion.hpp"

namespace gravure::cli {
namespace {

struct TexturePlanArguments {
  FreeformJob job;
  std::vector<std::string> limits;
  ServoOptions servos;
  std::string points;
  std::string trajectory;
  std::int64_t every = 20;
};

Result<void> write_trajectory(const TexturePlanArguments& options, const PathMotion& motion) {
  constexpr std::int64_t kBlock = 16'384;
  GRAVURE_TRY(TextOutput output, TextOutput::create(options.trajectory));
  output.text() += "t_s,X,Y,Z,A,C,U,V,along_mm\n";
  std::vector<PathInstant> block;
  const std::int64_t instants = motion.instants();
  for (std::int64_t first = 0; first < instants && !cancel_token().cancelled(); first += kBlock) {
    block.resize(static_cast<std::size_t>(std::min(kBlock, instants - first)));
    GRAVURE_CHECK(motion.read(first, block));
    for (std::size_t k = 0; k < block.size(); ++k) {
      const std::int64_t at = first + static_cast<std::int64_t>(k);
      if (at % options.every == 0 || at + 1 == instants) {
        const auto& a = block[k].axes;
        output.text() += fmt::format("{:.7f},{:.9f},{:.9f},{:.9f},{:.12f},{:.12f},{:.9f},{:.9f},{:.9f}\n",
                                     static_cast<double>(at) * options.job.motion.servo_us / kUsPerS, a[0], a[1], a[2],
                                     a[3], a[4], a[5] + 0.0, a[6] + 0.0, block[k].along_mm);
      }
    }
    if (!output.flush(false)) {
      break;
    }
  }
  if (cancel_token().cancelled()) {
    return Error{ErrorCode::cancelled, "stopped; nothing was written"};
  }
  return output.commit();
}

/// The stages alone on the same path.
Result<texture::TimedPath> time_stages(const TimedTexture& seven) {
  const std::span<const texture::SurfacePoint> targets = seven.timed.targets();
  GRAVURE_TRY(const std::vector<texture::SevenAxes> stages_alone,
              texture::seven_axes(seven.machine.machine, targets, targets, seven.machine.branch));
  texture::PathTimingRequest request = seven.timed.request(seven.machine, seven.path);
  request.axes = stages_alone;
  return texture::time_five_axes(request, cancel_token());
}

/// Each figure to what is the same on every machine.
void print_outcome(const TexturePlanArguments& options, const TimedTexture& seven, const texture::TimedPath& five,
                   const Following& following, const std::vector<std::string>& violations, const Command& command) {
  const texture::TimedPath& path = seven.proven.path;
  const double ratio = five.time_s / path.time_s;
  if (command.json) {
    Json json = split_json(surface_name(options.job.texture), seven.path, seven.timed.split);
    json["stops"] = stops_name(seven.machine.stops);
    json["time_s"] = {{"seven_axis", five_digits(path.time_s)}, {"five_axis", five_digits(five.time_s)}};
    json["ratio"] = five_digits(ratio);
    json["runs"] = path.runs;
    json["slowed_runs"] = path.slowed;
    json["instants"] = path.motion->instants();
    json["servo_us"] = options.job.motion.servo_us;
    json["limits"] = limits_json(options.job.motion, seven);
    json["following_error"] = following_json(following, seven.machine.servo_s);
    json["violations"] = violations;
    print_json(json);
    return;
  }
  std::string text =
      split_text(seven.path, seven.timed.split, options.job.split, how_sigma(options.job.split, seven.timed));
  text += seven_text(seven);
  text += fmt::format("five axes     {:.3f} s, {:.3f} times as long\n", five.time_s, ratio);
  text += limits_text(options.job.motion, seven) + following_text(following, seven.machine.servo_s);
  for (const std::string& violation : violations) {
    text += "violation: " + violation + "\n";
  }
  print(text);
}

Result<int> plan(TexturePlanArguments options, const Command& command) {
  GRAVURE_CHECK(refuse_overwrite({{"--points", options.points}, {"--trajectory", options.trajectory}},
                                 inputs_of(options.job.texture)));
  GRAVURE_CHECK(set_limits(options.limits, options.job.motion));
  GRAVURE_TRY(Following following, servos_of(options.servos));
  GRAVURE_TRY(const TimedTexture seven, time_texture(options.job));
  GRAVURE_TRY(const texture::TimedPath five, time_stages(seven));
  GRAVURE_CHECK(predict(following, *seven.proven.path.motion, seven.machine));
  if (!options.points.empty()) {
    GRAVURE_CHECK(write_points(options.points, seven.timed.split, seven.timed.axes, options.job.split.focus_axis));
  }
  if (!options.trajectory.empty()) {
    GRAVURE_CHECK(write_trajectory(options, *seven.proven.path.motion));
  }
  const std::vector<std::string> violations = violations_of(options.job, seven);
  print_outcome(options, seven, five, following, violations, command);
  return violations.empty() ? kDone : kLimitViolated;
}

}  // namespace

void add_texture_plan(CLI::App& texture, Command& command) {
  CLI::App* verb = add_verb(texture, command, "plan", "Time a path on a surface under the limits of all seven axes");
  const auto options = std::make_shared<TexturePlanArguments>();
  add_texture_options(*verb, options->job.texture);
  add_split_options(*verb, options->job.split, "by --rule");
  add_axes_options(*verb, options->job.axes);
  add_motion_options(*verb, options->job, options->limits);
  add_servo_options(*verb, options->servos);
  verb->add_option("--points", options->points, "CSV of every point, its stages' point, axes and deviations");
  verb->add_option("--trajectory", options->trajectory, "CSV of the set-points of all axes over time");
  verb->add_option("--every", options->every, "Every how many servo periods --trajectory has a line")
      ->check(integer_from(1, 1'000'000'000))
      ->capture_default_str();
  verb->callback([&command, options] { command.run = [&command, options] { return plan(*options, command); }; });
}

}  // namespace gravure::cli
