#include "texture/texture_outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <memory>
#include <utility>

namespace gravure::cli {
namespace {

constexpr double kMostTilt_rad = 20 / kDegreesPerRad;
constexpr double kWorthIt = 0.01;  // of the time, for a workpiece to be clamped otherwise

/// The stages alone on the same path.
Result<double> five_axes_s(const TimedTexture& seven) {
  const std::span<const texture::SurfacePoint> targets = seven.timed.targets();
  GRAVURE_TRY(const std::vector<texture::SevenAxes> stages_alone,
              texture::seven_axes(seven.machine.machine, targets, targets, seven.machine.branch));
  texture::PathTimingRequest request = seven.timed.request(seven.machine, seven.path);
  request.axes = stages_alone;
  GRAVURE_TRY(const texture::TimedPath five, texture::time_five_axes(request, cancel_token()));
  return five.time_s;
}

Result<std::optional<PublishedOutcome>> published_outcome(const FreeformJob& job, const TimedTexture& seven) {
  const double sigma_mm = seven.timed.published_mm;
  if (!(sigma_mm > seven.timed.split.sigma_mm)) {
    return std::optional<PublishedOutcome>();
  }
  GRAVURE_TRY(texture::Split split, texture::split_path(*splitter_of(job.split), *seven.surface, seven.path,
                                                        limits_of(job.split), sigma_mm, cancel_token()));
  GRAVURE_TRY(const texture::TimedSplit timed,
              texture::time_split(std::move(split), seven.path, seven.machine, cancel_token()));
  GRAVURE_TRY(const Following following, predict(job.motion, *timed.timed.motion, seven.machine));
  return std::optional(
      PublishedOutcome{sigma_mm, timed.split.most.max_focus_mm, timed.timed.time_s, following.errors.spot_mm});
}

/// Where the stages are what is slow, and C turns fast near the pole: another clamping is timed, too. Not for pictures,
/// whose programs are made of workpieces that lie level.
Result<std::optional<TiltOutcome>> tilt_outcome(const FreeformJob& job, const TimedTexture& seven) {
  if (seven.proven.path.slowed == 0 || !seven.timed.lying.empty() || !job.texture.bitmap.empty()) {
    return std::optional<TiltOutcome>();
  }
  GRAVURE_TRY(const texture::ClampingAdvice advice,
              texture::advise_clamping(seven.timed.split.stages, seven.path.step_mm, kMostTilt_rad, cancel_token()));
  if (!advice.pays) {
    return std::optional<TiltOutcome>();
  }
  texture::PathMachine machine = seven.machine;
  machine.clamping = advice.clamping;
  const Result<texture::TimedSplit> tilted =
      texture::time_split(seven.timed.split, seven.path, machine, cancel_token());
  if (!tilted && tilted.error().code == ErrorCode::cancelled) {
    return tilted.error();
  }
  return tilted && tilted.value().timed.time_s <= (1 - kWorthIt) * seven.proven.path.time_s
             ? std::optional(TiltOutcome{advice, tilted.value().timed.time_s})
             : std::nullopt;
}

std::string tilt_text(const TiltOutcome& tilt, double lying_s) {
  const texture::ClampingAdvice& advice = tilt.advice;
  return fmt::format(
      "clamping      --tilt-deg {:.4g} {:.4g} would take {:.3f} s instead of {:.3f}: C {:.4g} rad a mm at most, not "
      "{:.4g}\n",
      advice.clamping.about_x_rad * kDegreesPerRad, advice.clamping.about_y_rad * kDegreesPerRad, tilt.time_s, lying_s,
      advice.tilted.max_rate_rad_per_mm, advice.flat.max_rate_rad_per_mm);
}

}  // namespace

Result<TextureOutcome> outcome_of(const FreeformJob& job, Depth depth, const Command& command) {
  TextureOutcome outcome;
  GRAVURE_TRY(outcome.seven, time_texture(job, command));
  const TimedTexture& seven = outcome.seven;
  outcome.violations = violations_of(job, seven);
  if (depth == Depth::motion) {
    return outcome;
  }
  if (depth == Depth::times) {
    GRAVURE_TRY(outcome.five_s, placed(job, "motion", five_axes_s(seven)));
    return outcome;
  }
  // Nothing of one is of use to the others: a thread for what takes half of the time.
  auto published = std::async(std::launch::async, [&] { return published_outcome(job, seven); });
  Result<double> five_s = placed(job, "motion", five_axes_s(seven));
  Result<Following> following = predict(job.motion, *seven.proven.path.motion, seven.machine);
  Result<std::optional<TiltOutcome>> tilt = tilt_outcome(job, seven);
  GRAVURE_TRY(outcome.published, published.get());
  GRAVURE_TRY(outcome.five_s, std::move(five_s));
  GRAVURE_TRY(outcome.following, std::move(following));
  GRAVURE_TRY(outcome.tilt, std::move(tilt));
  return outcome;
}

Json clamping_json(const texture::ClampingAdvice& advice) {
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

Json outcome_json(const FreeformJob& job, const TextureOutcome& outcome) {
  const TimedTexture& seven = outcome.seven;
  const texture::TimedPath& path = seven.proven.path;
  Json json = split_json(surface_name(job.texture), seven.path, seven.timed.split, job.split);
  json["stops"] = stops_name(seven.machine.stops);
  json["time_s"] = {{"seven_axis", five_digits(path.time_s)}, {"five_axis", five_digits(outcome.five_s)}};
  json["ratio"] = five_digits(outcome.ratio());
  json["runs"] = path.runs;
  json["slowed_runs"] = path.slowed;
  json["instants"] = path.motion->instants();
  json["servo_us"] = job.motion.servo_us;
  json["limits"] = limits_json(job.motion, seven);
  if (outcome.following) {
    json["following_error"] = following_json(*outcome.following, seven.machine.servo_s);
    json["published_rule"] = nullptr;
    json["clamping"] = nullptr;
  }
  if (outcome.published) {
    const PublishedOutcome& published = *outcome.published;
    json["published_rule"] = {{"sigma_um", figure(published.sigma_mm * kUmPerMm)},
                              {"fod_um", {{"max", figure(published.max_focus_mm * kUmPerMm)}}},
                              {"time_s", {{"seven_axis", five_digits(published.time_s)}}},
                              {"spot_um",
                               {{"max", rounded(published.spot_mm.max * kUmPerMm, 6)},
                                {"rms", rounded(published.spot_mm.rms * kUmPerMm, 6)}}}};
  }
  if (outcome.tilt) {
    json["clamping"] = clamping_json(outcome.tilt->advice);
    json["clamping"]["time_s"] = {{"seven_axis", five_digits(outcome.tilt->time_s)}};
  }
  json["violations"] = outcome.violations;
  return json;
}

std::string times_text(const TextureOutcome& outcome) {
  return seven_text(outcome.seven) +
         fmt::format("five axes     {:.3f} s, {:.3f} times as long\n", outcome.five_s, outcome.ratio());
}

std::string outcome_text(const FreeformJob& job, const TextureOutcome& outcome) {
  const TimedTexture& seven = outcome.seven;
  std::string text = split_text(seven.path, seven.timed.split, job.split, how_sigma(job.split, seven.timed));
  text += times_text(outcome) + limits_text(job.motion, seven);
  text += outcome.following ? following_text(*outcome.following, seven.machine.servo_s) : "";
  if (outcome.published) {
    const PublishedOutcome& published = *outcome.published;
    text += fmt::format(
        "published     by --rule published: sigma {:.3f} um, {:.3f} s, focus offset {:.3f} um, spot {:.4f} um behind "
        "at "
        "most; here {:.3g} times that\n",
        published.sigma_mm * kUmPerMm, published.time_s, published.max_focus_mm * kUmPerMm,
        published.spot_mm.max * kUmPerMm, outcome.following->errors.spot_mm.max / published.spot_mm.max);
  }
  text += outcome.tilt ? tilt_text(*outcome.tilt, seven.proven.path.time_s) : "";
  return text + violations_text(outcome.violations);
}

std::string violations_text(const std::vector<std::string>& violations) {
  std::string text;
  for (const std::string& violation : violations) {
    text += "violation: " + violation + "\n";
  }
  return text;
}

}  // namespace gravure::cli
