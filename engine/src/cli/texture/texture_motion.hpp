#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gravure/formats/freeform_job.hpp"
#include "gravure/texture/best_sigma.hpp"
#include "placed_error.hpp"
#include "texture/texture_options.hpp"

namespace gravure::cli {

inline constexpr double kUsPerS = 1e6;

/// To five digits: what is less of a time or a motion depends on the machine it is reckoned on.
double five_digits(double value);

/// A texture on a surface, split, timed under the limits of all seven axes, and proved instant by instant.
struct TimedTexture {
  std::unique_ptr<texture::Surface> surface;
  texture::TexturePath path;
  texture::PathMachine machine;
  texture::TimedSplit timed;
  texture::ProvenPath proven;
};

/// Where the job says what the error is about: at the key, axis or thing that the message begins with, else at `key`.
/// Without a job file it says so already.
Error placed_error(const FreeformJob& job, std::string_view key, Error error);
template <class T>
Result<T> placed(const FreeformJob& job, std::string_view key, Result<T> result) {
  return result ? std::move(result) : Result<T>(placed_error(job, key, result.error()));
}

/// Those of [A] table 1 where none are given; with a focus axis W's, which has none there: check_focus_axis().
texture::AxesLimits axes_limits_of(const FreeformJob& job);

/// bad_argument for a focus axis whose limits are not all stated, and for what is said of one that is not there.
Result<void> check_focus_axis(const FreeformJob& job);

/// What planning may take where --memory is left out.
inline constexpr std::int64_t kTextureMemory_mib = 1024;
/// `--memory` of the verbs that plan textures.
void add_texture_memory(CLI::App& verb, Command& command);
/// Of verbs whose --memory is for the buffers of other jobs: it can allow more for a texture, not less.
Command with_texture_memory(const Command& command);

/// What plan, compile and jobs do alike: by --sigma-um, else by --rule. out_of_range for a path that would take more
/// memory than the command allows.
Result<TimedTexture> time_texture(const FreeformJob& job, const Command& command);

/// Surface, path and split alone, by --sigma-um, else by the published rule.
Result<TimedTexture> untimed_texture(const FreeformJob& job, const Command& command);

/// The limits that are broken: of the split, and of the axes.
std::vector<std::string> violations_of(const FreeformJob& job, const TimedTexture& texture);

/// How sigma was found, for split_text().
std::string how_sigma(const SplitSettings& settings, const texture::TimedSplit& timed);
const char* stops_name(texture::Stops stops);
/// The most that each limit is used, and where it comes from.
Json limits_json(const MotionSettings& motion, const TimedTexture& texture);
/// "seven axes ..." and "limit ..." as lines for people.
std::string seven_text(const TimedTexture& texture);
std::string limits_text(const MotionSettings& motion, const TimedTexture& texture);

}  // namespace gravure::cli
