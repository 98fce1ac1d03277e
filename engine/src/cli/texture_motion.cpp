#include "texture_motion.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

namespace gravure::cli {
namespace {

constexpr double kPercent = 100;

Result<texture::PathMachine> path_machine_of(const FreeformJob& job) {
  texture::PathMachine machine;
  machine.machine = machine_of(job.axes);
  machine.branch = branch_of(job.axes);
  machine.clamping = clamping_of(job.axes);
  machine.limits = seven_limits_of(job.motion);
  GRAVURE_CHECK(texture::check_limits(machine.limits));
  const bool points = job.motion.stops.empty() ? job.texture.hilbert_order != 0 : job.motion.stops == "points";
  machine.stops = points ? texture::Stops::points : texture::Stops::corners;
  machine.servo_s = job.motion.servo_us / kUsPerS;
  return machine;
}

Result<texture::TimedSplit> timed_split(const SplitSettings& settings, const texture::Surface& surface,
                                        const texture::TexturePath& path, const texture::PathMachine& machine) {
  const std::unique_ptr<texture::Splitter> splitter = splitter_of(settings);
  const texture::DeviationLimits limits = limits_of(settings);
  if (!settings.sigma_um && settings.rule == "time") {
    return texture::split_by_time(*splitter, surface, path, limits, machine, settings.time_share_percent / kPercent,
                                  cancel_token());
  }
  GRAVURE_TRY(texture::Split split,
              settings.sigma_um
                  ? texture::split_path(*splitter, surface, path, limits, *settings.sigma_um / kUmPerMm, cancel_token())
                  : texture::split_by_published_rule(*splitter, surface, path, limits, cancel_token()));
  return texture::time_split(std::move(split), path, machine, cancel_token());
}

/// Stated, or that of published_limits().
std::string_view limit_source(const MotionSettings& motion, const texture::LimitUse& use) {
  const GivenBounds& given = motion.limits[use.axis];
  const std::optional<double>& bound = use.kind == texture::LimitKind::speed          ? given.speed
                                       : use.kind == texture::LimitKind::acceleration ? given.acceleration
                                                                                      : given.jerk;
  return bound ? "stated" : texture::source_name(texture::source_of_published(use.axis, use.kind));
}

}  // namespace

Error placed_error(const FreeformJob& job, std::string_view key, Error error) {
  if (error.code == ErrorCode::cancelled) {
    return error;
  }
  std::string at(key);
  for (const auto& [name, place] : job.job.places) {
    const std::string last = name.substr(name.find_last_of('.') + 1) + " ";
    const bool begins = error.message.rfind(name + " ", 0) == 0 || error.message.rfind(last, 0) == 0;
    at = begins && name.find('.') != std::string::npos ? name : at;
  }
  error.message = job.job.place_of(at) + error.message;
  return error;
}

double five_digits(double value) {
  constexpr double kDigits = 1e5;
  return std::round(value * kDigits) / kDigits + 0.0;
}

texture::SevenLimits seven_limits_of(const MotionSettings& motion) {
  texture::SevenLimits limits = texture::published_limits();
  for (std::size_t axis = 0; axis < limits.size(); ++axis) {
    const GivenBounds& given = motion.limits[axis];
    texture::AxisBounds& bounds = limits[axis];
    bounds = {given.speed.value_or(bounds.speed), given.acceleration.value_or(bounds.acceleration),
              given.jerk.value_or(bounds.jerk)};
  }
  return limits;
}

Result<TimedTexture> time_texture(const FreeformJob& job) {
  TimedTexture texture;
  GRAVURE_TRY(texture.machine, path_machine_of(job));
  GRAVURE_TRY(const std::unique_ptr<texture::Surface> surface, placed(job, "surface", surface_of(job.texture)));
  GRAVURE_TRY(texture.path, placed(job, "texture", path_of(job.texture)));
  GRAVURE_TRY(texture.timed, placed(job, "limits", timed_split(job.split, *surface, texture.path, texture.machine)));
  GRAVURE_TRY(texture.proven,
              texture::prove_seven_axes(texture.timed.request(texture.machine, texture.path), cancel_token()));
  return texture;
}

std::vector<std::string> violations_of(const FreeformJob& job, const TimedTexture& texture) {
  std::vector<std::string> found = texture::violations(texture.timed.split.most, limits_of(job.split));
  for (const texture::LimitUse& use : texture::broken(texture.proven.uses)) {
    found.push_back(fmt::format("axis {}: {} {:.6g}, allowed {:.6g}, at {:.4f} s", kPathAxes[use.axis],
                                texture::limit_name(use.kind), use.most, use.allowed,
                                static_cast<double>(use.instant) * texture.machine.servo_s));
  }
  return found;
}

std::string how_sigma(const SplitSettings& settings, const texture::TimedSplit& timed) {
  if (settings.sigma_um) {
    return "";
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
    text +=
        fmt::format("limit         {} {:<12} {:6.2f} % at {:.4f} s of {:.6g} ({})\n", kPathAxes[use.axis],
                    texture::limit_name(use.kind), use.share() * kPercent,
                    static_cast<double>(use.instant) * texture.machine.servo_s, use.allowed, limit_source(motion, use));
  }
  return text;
}

}  // namespace gravure::cli
