#include "texture_plan_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "gravure/kinematics/machines.hpp"
#include "gravure/texture/best_sigma.hpp"
#include "program_files.hpp"
#include "texture_following.hpp"
#include "texture_options.hpp"

namespace gravure::cli {
namespace {

constexpr double kUsPerS = 1e6;
constexpr double kPercent = 100;

struct Options {
  TextureOptions texture;
  SplitOptions split;
  std::string points;
  std::string rule = "time";
  double share_percent = 0.5;
  std::string stops;
  double servo_us = 50;
  std::vector<std::string> limits;
  ServoOptions servos;
  std::string trajectory;
  std::int64_t every = 20;
};

/// "X=100,200,300" into the limits.
Result<void> set_limit(const std::string& text, texture::SevenLimits& limits) {
  GRAVURE_TRY(const AxisSetting setting, axis_setting("--limit", text, "AXIS=SPEED,ACCELERATION,JERK"));
  limits[setting.axis] = {setting.numbers[0], setting.numbers[1], setting.numbers[2]};
  return {};
}

Result<texture::PathMachine> machine_of(const Options& options) {
  texture::PathMachine machine;
  machine.machine = kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, kinematics::Vector3::Zero(), {});
  machine.limits = texture::published_limits();
  for (const std::string& limit : options.limits) {
    GRAVURE_CHECK(set_limit(limit, machine.limits));
  }
  GRAVURE_CHECK(texture::check_limits(machine.limits));
  const bool points = options.stops.empty() ? options.texture.hilbert_order != 0 : options.stops == "points";
  machine.stops = points ? texture::Stops::points : texture::Stops::corners;
  machine.servo_s = options.servo_us / kUsPerS;
  return machine;
}

Result<texture::TimedSplit> timed_split(const Options& options, const texture::Surface& surface,
                                        const texture::TexturePath& path, const texture::PathMachine& machine) {
  const std::unique_ptr<texture::Splitter> splitter = splitter_of(options.split);
  const texture::DeviationLimits limits = limits_of(options.split);
  if (options.split.sigma_um) {
    GRAVURE_TRY(texture::Split split, texture::split_path(*splitter, surface, path, limits,
                                                          *options.split.sigma_um / kUmPerMm, cancel_token()));
    return texture::time_split(std::move(split), path, machine, cancel_token());
  }
  if (options.rule == "time") {
    return texture::split_by_time(*splitter, surface, path, limits, machine, options.share_percent / kPercent,
                                  cancel_token());
  }
  GRAVURE_TRY(texture::Split split, texture::split_by_published_rule(*splitter, surface, path, limits, cancel_token()));
  return texture::time_split(std::move(split), path, machine, cancel_token());
}

Result<void> write_trajectory(const Options& options, const PathMotion& motion) {
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
                                     static_cast<double>(at) * options.servo_us / kUsPerS, a[0], a[1], a[2], a[3], a[4],
                                     a[5] + 0.0, a[6] + 0.0, block[k].along_mm);
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

/// What is printed of the motion, each figure to what is the same on every machine.
struct Outcome {
  texture::ProvenPath seven;
  texture::TimedPath five;
  Following following;
  std::vector<std::string> violations;
  double ratio() const { return five.time_s / seven.path.time_s; }
};

double rounded(double value) {
  constexpr double kDigits = 1e5;
  return std::round(value * kDigits) / kDigits + 0.0;
}

/// Where a limit comes from: --limit of its axis, else published_limits().
std::string_view limit_source(const Options& options, const texture::LimitUse& use) {
  const bool stated = std::any_of(options.limits.begin(), options.limits.end(), [&use](const std::string& text) {
    return text.substr(0, text.find('=')) == kPathAxes[use.axis];
  });
  return stated ? "stated" : texture::source_name(texture::source_of_published(use.axis, use.kind));
}

Json limits_json(const Options& options, const std::vector<texture::LimitUse>& uses, double servo_s) {
  Json limits = Json::array();
  for (const texture::LimitUse& use : uses) {
    limits.push_back({{"axis", kPathAxes[use.axis]},
                      {"kind", texture::limit_name(use.kind)},
                      {"most", rounded(use.most)},
                      {"allowed", use.allowed},
                      {"source", limit_source(options, use)},
                      {"share", rounded(use.share())},
                      {"at_s", rounded(static_cast<double>(use.instant) * servo_s)}});
  }
  return limits;
}

void print_outcome(const Options& options, const texture::TexturePath& path, const texture::PathMachine& machine,
                   const texture::TimedSplit& timed, const Outcome& outcome, const Command& command) {
  const texture::TimedPath& seven = outcome.seven.path;
  const char* stops = machine.stops == texture::Stops::points ? "points" : "corners";
  if (command.json) {
    Json json = split_json(surface_name(options.texture), path, timed.split);
    json["stops"] = stops;
    json["time_s"] = {{"seven_axis", rounded(seven.time_s)}, {"five_axis", rounded(outcome.five.time_s)}};
    json["ratio"] = rounded(outcome.ratio());
    json["runs"] = seven.runs;
    json["slowed_runs"] = seven.slowed;
    json["instants"] = seven.motion->instants();
    json["servo_us"] = options.servo_us;
    json["limits"] = limits_json(options, outcome.seven.uses, machine.servo_s);
    json["following_error"] = following_json(outcome.following, machine.servo_s);
    json["violations"] = outcome.violations;
    print_json(json);
    return;
  }
  std::string text =
      split_text(path, timed.split, options.split,
                 options.split.sigma_um || options.rule != "time"
                     ? ""
                     : fmt::format(", within {:.6g} % of the fastest of {}", options.share_percent, timed.tries));
  text += fmt::format("seven axes    {:.3f} s, at rest at {}, {} of {} moves slowed for the stages\n", seven.time_s,
                      stops, seven.slowed, seven.runs);
  text += fmt::format("five axes     {:.3f} s, {:.3f} times as long\n", outcome.five.time_s, outcome.ratio());
  for (const texture::LimitUse& use : outcome.seven.uses) {
    text += fmt::format("limit         {} {:<12} {:6.2f} % at {:.4f} s of {:.6g} ({})\n", kPathAxes[use.axis],
                        texture::limit_name(use.kind), use.share() * kPercent,
                        static_cast<double>(use.instant) * machine.servo_s, use.allowed, limit_source(options, use));
  }
  text += following_text(outcome.following, machine.servo_s);
  for (const std::string& violation : outcome.violations) {
    text += "violation: " + violation + "\n";
  }
  print(text);
}

Result<int> plan(const Options& options, const Command& command) {
  GRAVURE_CHECK(
      refuse_overwrite({{"--points", options.points}, {"--trajectory", options.trajectory}}, {options.texture.path}));
  GRAVURE_TRY(const texture::PathMachine machine, machine_of(options));
  Outcome outcome;
  GRAVURE_TRY(outcome.following, servos_of(options.servos));
  GRAVURE_TRY(const std::unique_ptr<texture::Surface> surface, surface_of(options.texture));
  GRAVURE_TRY(const texture::TexturePath path, path_of(options.texture));
  GRAVURE_TRY(const texture::TimedSplit timed, timed_split(options, *surface, path, machine));
  texture::PathTimingRequest request = timed.request(machine, path);
  GRAVURE_TRY(outcome.seven, texture::prove_seven_axes(request, cancel_token()));
  GRAVURE_TRY(const std::vector<texture::SevenAxes> stages_alone,
              texture::seven_axes(machine.machine, timed.split.targets, timed.split.targets));
  request.axes = stages_alone;
  GRAVURE_TRY(outcome.five, texture::time_five_axes(request, cancel_token()));
  GRAVURE_CHECK(predict(outcome.following, *outcome.seven.path.motion, machine));
  outcome.violations = texture::violations(timed.split.most, limits_of(options.split));
  for (const texture::LimitUse& use : texture::broken(outcome.seven.uses)) {
    outcome.violations.push_back(fmt::format("axis {}: {} {:.6g}, allowed {:.6g}, at {:.4f} s", kPathAxes[use.axis],
                                             texture::limit_name(use.kind), use.most, use.allowed,
                                             static_cast<double>(use.instant) * machine.servo_s));
  }
  if (!options.points.empty()) {
    GRAVURE_CHECK(write_points(options.points, timed.split, timed.axes, options.split.focus_axis));
  }
  if (!options.trajectory.empty()) {
    GRAVURE_CHECK(write_trajectory(options, *outcome.seven.path.motion));
  }
  print_outcome(options, path, machine, timed, outcome, command);
  return outcome.violations.empty() ? kDone : kLimitViolated;
}

}  // namespace

void add_texture_plan(CLI::App& texture, Command& command) {
  CLI::App* verb = add_verb(texture, command, "plan", "Time a path on a surface under the limits of all seven axes");
  const auto options = std::make_shared<Options>();
  add_texture_options(*verb, options->texture);
  add_split_options(*verb, options->split, "by --rule");
  verb->add_option("--rule", options->rule, "time: the smallest that costs no time; published: the first of 30000 ...")
      ->check(CLI::IsMember({"time", "published"}))
      ->capture_default_str();
  verb->add_option("--time-share-percent", options->share_percent, "How much longer than the fastest, for --rule time")
      ->check(number_from(0, 1000))
      ->capture_default_str();
  verb->add_option("--stops", options->stops, "points or corners; left out: points of a Hilbert curve, else corners")
      ->check(CLI::IsMember({"points", "corners"}));
  verb->add_option("--limit", options->limits,
                   "AXIS=SPEED,ACCELERATION,JERK of one axis, mm or rad per s, s^2, s^3; as often as needed");
  add_servo_options(*verb, options->servos);
  add_length(*verb, "--servo-us", options->servo_us, 1e6, "Servo period")->capture_default_str();
  verb->add_option("--points", options->points, "CSV of every point, its stages' point, axes and deviations");
  verb->add_option("--trajectory", options->trajectory, "CSV of the set-points of all axes over time");
  verb->add_option("--every", options->every, "Every how many servo periods --trajectory has a line")
      ->check(integer_from(1, 1'000'000'000))
      ->capture_default_str();
  verb->callback([&command, options] { command.run = [&command, options] { return plan(*options, command); }; });
}

}  // namespace gravure::cli
