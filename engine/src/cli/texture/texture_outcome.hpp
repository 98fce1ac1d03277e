#pragma once

#include <optional>
#include <string>
#include <vector>

#include "texture/texture_following.hpp"
#include "texture/texture_motion.hpp"

namespace gravure::cli {

/// What the rule of [A] would have made of a texture for which the job's rule has found a smaller sigma.
struct PublishedOutcome {
  double sigma_mm = 0;
  double max_focus_mm = 0;
  double time_s = 0;
  texture::FollowingError spot_mm;
};

/// A clamping in which the motion takes less time than as the workpiece lies.
struct TiltOutcome {
  texture::ClampingAdvice advice;
  double time_s = 0;
};

/// What there is to say of a texture, whichever verb says it.
struct TextureOutcome {
  TimedTexture seven;
  double five_s = 0;  ///< the stages alone on the same path
  std::vector<std::string> violations;
  // What only those ask for who choose between motions:
  std::optional<Following> following;
  std::optional<PublishedOutcome> published;
  std::optional<TiltOutcome> tilt;
  double ratio() const noexcept { return five_s / seven.proven.path.time_s; }
};

/// How much of it is wanted: seven axes alone, what every verb says, or what choosing takes as well (and as much time
/// again).
enum class Depth : std::uint8_t { motion, times, choice };

/// Errors as time_texture().
Result<TextureOutcome> outcome_of(const FreeformJob& job, Depth depth, const Command& command);

/// Largest of each, then times, ratio, limits[] and violations[], each figure to what is the same on every machine.
Json outcome_json(const FreeformJob& job, const TextureOutcome& outcome);
/// The same as lines for people.
std::string outcome_text(const FreeformJob& job, const TextureOutcome& outcome);
/// "seven axes ..." and "five axes ..."
std::string times_text(const TextureOutcome& outcome);
/// "violation: ..." lines.
std::string violations_text(const std::vector<std::string>& violations);

Json clamping_json(const texture::ClampingAdvice& advice);

}  // namespace gravure::cli
