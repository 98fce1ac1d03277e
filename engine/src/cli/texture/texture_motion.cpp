#include "texture/texture_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "gravure/texture/planning_memory.hpp"
#include "program/path_program.hpp"

namespace gravure::cli {
namespace {

constexpr double kPercent = 100;

Result<texture::PathMachine> path_machine_of(const FreeformJob& job) {
  GRAVURE_CHECK(check_focus_axis(job));
  texture::PathMachine machine;
  machine.machine = machine_of(job.axes);
  machine.branch = branch_of(job.axes);
  machine.clamping = clamping_of(job.axes);
  machine.limits = axes_limits_of(job);
  GRAVURE_CHECK(texture::check_limits(machine.limits));
  const bool points = job.motion.stops.empty() ? job.texture.hilbert_order != 0 : job.motion.stops == "points";
  machine.stops = points ? texture::Stops::points : texture::Stops::corners;
  machine.servo_s = job.motion.servo_us / kUsPerS;
  machine.corner_law = true;
  return machine;
}

/// By the sigma that is given, else by the published rule.
Result<texture::Split> plain_split(const SplitSettings& settings, const texture::Surface& surface,
                                   const texture::TexturePath& path) {
  const std::unique_ptr<texture::Splitter> splitter = splitter_of(settings);
  const texture::DeviationLimits limits = limits_of(settings);
  return settings.sigma_um
             ? texture::split_path(*splitter, surface, path, limits, *settings.sigma_um / kUmPerMm, cancel_token())
             : texture::split_by_published_rule(*splitter, surface, path, limits, cancel_token());
}

Result<texture::TimedSplit> timed_split(const SplitSettings& settings, const texture::Surface& surface,
                                        const texture::TexturePath& path, const texture::PathMachine& machine) {
  if (!settings.sigma_um && settings.rule == "time") {
    ProgressBar bar("sigma", "tries");
    return texture::split_by_time(*splitter_of(settings), surface, path, limits_of(settings), machine,
                                  settings.time_share_percent / kPercent, cancel_token(), &bar);
  }
  GRAVURE_TRY(texture::Split split, plain_split(settings, surface, path));
  return texture::time_split(std::move(split), path, machine, cancel_token());
}

Result<void> check_memory(std::size_t points, const Command& command) {
  Result<void> checked = texture::check_planning_memory(points, command.memory_bytes());
  return checked ? checked : Error{checked.error().code, checked.error().message + " (--memory)"};
}

/// What a sigma of one's own can do: below, the filter does nothing; above, it only takes memory.
Result<void> check_sigma(const SplitSettings& settings, const texture::TexturePath& path) {
  constexpr double kPublished_um = 30'000;
  const double step_um = path.step_mm * kUmPerMm;
  const double least_um = step_um / 10;
  const double most_um = std::max(kPublished_um, static_cast<double>(path.points_mm.size() - 1) * step_um);
  if (settings.sigma_um && !(*settings.sigma_um >= least_um && *settings.sigma_um <= most_um)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("sigma_um = {:.6g}: must be {:.6g} (a tenth of the {:.6g} um from point to point) to "
                             "{:.6g} (the length of the path, or 30000)",
                             *settings.sigma_um, least_um, step_um, most_um)};
  }
  return {};
}

/// Surface and path, and whether the sigma that is given suits them.
Result<TimedTexture> surface_and_path(const FreeformJob& job, const Command& command) {
  TimedTexture texture;
  GRAVURE_TRY(texture.surface, placed(job, "surface", surface_of(job.texture)));
  GRAVURE_TRY(texture.path, placed(job, "texture", path_of(job.texture)));
  GRAVURE_CHECK(placed(job, "texture", check_memory(texture.path.points_mm.size(), command)));
  GRAVURE_CHECK(placed(job, "split.sigma_um", check_sigma(job.split, texture.path)));
  return texture;
}

const char* limit_unit(const texture::LimitUse& use) {
  constexpr const char* kUnits[2][3] = {{"mm/s", "mm/s^2", "mm/s^3"}, {"rad/s", "rad/s^2", "rad/s^3"}};
  return kUnits[axis_turns(use.axis) ? 1 : 0][static_cast<std::size_t>(use.kind)];
}

/// Degrees, as job keys and `verify` have them, with the rad that `--limit` takes behind.
std::string limit_shown(const texture::LimitUse& use, double value) {
  constexpr const char* kPer[] = {"s", "s^2", "s^3"};
  const std::string shown = fmt::format("{:.6g} {}", value, limit_unit(use));
  return axis_turns(use.axis) ? fmt::format("{:.6g} deg/{} = {}", value * kDegreesPerRad,
                                            kPer[static_cast<std::size_t>(use.kind)], shown)
                              : shown;
}

/// Stated, or that of published_limits().
std::string_view limit_source(const MotionSettings& motion, const texture::LimitUse& use) {
  const GivenBounds& given = motion.limits[use.axis];
  const std::optional<double>& bound = use.kind == texture::LimitKind::speed          ? given.speed
                                       : use.kind == texture::LimitKind::acceleration ? given.acceleration
                                                                                      : given.jerk;
  return bound ? "stated" : texture::source_name(texture::source_of_published(use.axis, use.kind));
}

/// The section that a message is about, by how it begins; else `key`.
std::string key_of(const Job& job, std::string_view message, std::string_view key) {
  constexpr std::string_view kAxis = "axis ";
  if (message.starts_with(kAxis)) {
    const std::string section = "axis." + std::string(message.substr(kAxis.size(), 1));
    for (const auto& [name, place] : job.places) {
      const bool is_limit = name.starts_with(section + ".max_");
      if (is_limit && message.find(name.substr(section.size() + 5, 4)) < message.find(',')) {
        return name;
      }
    }
    return job.places.count(section) != 0 ? section : "motion";
  }
  constexpr std::pair<std::string_view, std::string_view> kBeginnings[] = {
      {"surface", "surface"},     {"mesh", "surface"},    {"height", "surface"}, {"the stages' path", "surface"},
      {"servo period", "motion"}, {"point ", "clamping"}, {"sigma", "split"}};
  for (const auto& [beginning, section] : kBeginnings) {
    if (message.starts_with(beginning)) {
      return std::string(section);
    }
  }
  return std::string(key);
}

}  // namespace

Error placed_error(const FreeformJob& job, std::string_view key, Error error) {
  const std::string at = key_of(job.job, error.message, key);
  return placed_error(job.job, at, std::move(error));
}

double five_digits(double value) {
  constexpr double kDigits = 1e5;
  return std::round(value * kDigits) / kDigits + 0.0;
}

Result<void> check_focus_axis(const FreeformJob& job) {
  const GivenBounds& limits = job.motion.limits[kFocusAxis];
  const GivenServo& servo = job.motion.servos[kFocusAxis];
  if (job.split.focus_axis && !(limits.speed && limits.acceleration && limits.jerk)) {
    return Error{ErrorCode::bad_argument,
                 "axis W: speed, acceleration and jerk of the focus axis are published nowhere: give all three with "
                 "--limit W=SPEED,ACCELERATION,JERK (mm per s, s^2, s^3)"};
  }
  if (!job.split.focus_axis &&
      (limits.speed || limits.acceleration || limits.jerk || servo.natural_hz || servo.damping || job.split.focus_mm)) {
    return Error{ErrorCode::bad_argument, "axis W: limits, servo and reach have a meaning only with --focus-axis"};
  }
  return {};
}

texture::AxesLimits axes_limits_of(const FreeformJob& job) {
  texture::AxesLimits limits = texture::published_limits();
  if (job.split.focus_axis) {
    limits.emplace_back();
  }
  for (std::size_t axis = 0; axis < limits.size(); ++axis) {
    const GivenBounds& given = job.motion.limits[axis];
    texture::AxisBounds& bounds = limits[axis];
    bounds = {given.speed.value_or(bounds.speed), given.acceleration.value_or(bounds.acceleration),
              given.jerk.value_or(bounds.jerk)};
  }
  return limits;
}

void add_texture_memory(CLI::App& verb, Command& command) {
  verb.add_option("--memory", command.memory_mib,
                  fmt::format("Most memory that planning a texture may take in MiB ({})", kTextureMemory_mib))
      ->check(integer_from(1, std::uint64_t{1} << 20));
  verb.parse_complete_callback([&verb, &command] {
    if (verb.count("--memory") == 0) {
      command.memory_mib = kTextureMemory_mib;
    }
  });
}

Command with_texture_memory(const Command& command) {
  Command texture = command;
  texture.memory_mib = std::max(command.memory_mib, kTextureMemory_mib);
  return texture;
}

Result<TimedTexture> time_texture(const FreeformJob& job, const Command& command) {
  GRAVURE_TRY(TimedTexture texture, surface_and_path(job, command));
  GRAVURE_TRY(texture.machine, placed(job, "motion", path_machine_of(job)));
  GRAVURE_TRY(texture.timed,
              placed(job, "limits", timed_split(job.split, *texture.surface, texture.path, texture.machine)));
  ProgressBar bar("prove", "periods");
  texture::PathTimingRequest request = texture.timed.request(texture.machine, texture.path);
  request.progress = &bar;
  GRAVURE_TRY(texture.proven, placed(job, "motion", texture::prove_seven_axes(request, cancel_token())));
  return texture;
}

Result<TimedTexture> untimed_texture(const FreeformJob& job, const Command& command) {
  GRAVURE_TRY(TimedTexture texture, surface_and_path(job, command));
  GRAVURE_TRY(texture.timed.split, placed(job, "limits", plain_split(job.split, *texture.surface, texture.path)));
  return texture;
}

std::vector<std::string> violations_of(const FreeformJob& job, const TimedTexture& texture) {
  std::vector<std::string> found = texture::violations(texture.timed.split.most, limits_of(job.split));
  for (const texture::LimitUse& use : texture::broken(texture.proven.uses)) {
    found.push_back(fmt::format("axis {}: {} {}, allowed {}, at {:.4f} s", kPathAxes[use.axis],
                                texture::limit_name(use.kind), limit_shown(use, use.most),
                                limit_shown(use, use.allowed),
                                static_cast<double>(use.instant) * texture.machine.servo_s));
  }
  return found;
}

std::string how_sigma(const SplitSettings& settings, const texture::TimedSplit& timed) {
  if (settings.sigma_um) {
    return "";
  }
  if (settings.method == "adaptive") {
    return " at most, narrowed where limits ask for it";
  }
  return settings.rule == "time"
             ? fmt::format(", within {:.6g} % of the fastest of {}", settings.time_share_percent, timed.tries)
             : fmt::format(", number {} from 30000 um by 0.95", timed.split.tries - 1);
}

const char* stops_name(texture::Stops stops) {
  return stops == texture::Stops::points ? "points" : "corners";
}

Json limits_json(const MotionSettings& motion, const TimedTexture& texture) {
  Json limits = Json::array();
  for (const texture::LimitUse& use : texture.proven.uses) {
    limits.push_back({{"axis", kPathAxes[use.axis]},
                      {"kind", texture::limit_name(use.kind)},
                      {"unit", limit_unit(use)},
                      {"most", five_digits(use.most)},
                      {"allowed", use.allowed},
                      {"source", limit_source(motion, use)},
                      {"share", five_digits(use.share())},
                      {"at_s", five_digits(static_cast<double>(use.instant) * texture.machine.servo_s)}});
  }
  return limits;
}

std::string seven_text(const TimedTexture& texture) {
  const texture::TimedPath& seven = texture.proven.path;
  return fmt::format("seven axes    {:.3f} s, at rest at {}, {} of {} moves slowed for the stages\n", seven.time_s,
                     stops_name(texture.machine.stops), seven.slowed, seven.runs);
}

std::string limits_text(const MotionSettings& motion, const TimedTexture& texture) {
  std::string text;
  for (const texture::LimitUse& use : texture.proven.uses) {
    text += fmt::format("limit         {} {:<12} {:6.2f} % at {:.4f} s of {} ({})\n", kPathAxes[use.axis],
                        texture::limit_name(use.kind), use.share() * kPercent,
                        static_cast<double>(use.instant) * texture.machine.servo_s, limit_shown(use, use.allowed),
                        limit_source(motion, use));
  }
  return text;
}

}  // namespace gravure::cli
