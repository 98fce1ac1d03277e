#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gravure/core/program.hpp"
#include "gravure/formats/freeform_job.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/pipeline/compile_path.hpp"
#include "texture/texture_outcome.hpp"

namespace gravure::cli {

/// What a job asks for, whatever the motion: where light belongs on the workpiece, and which pulses fire.
struct WantedTexture {
  std::vector<PathTarget> targets;
  PathPulses pulses;
  std::optional<texture::PictureGrid> picture;
};

/// Of points that lie on the surface, as it is clamped. bad_argument for what programs are not made of: a tilted
/// picture, no pitch.
Result<WantedTexture> wanted_of(const FreeformJob& job, const texture::TexturePath& path,
                                std::span<const texture::SurfacePoint> on_surface,
                                std::span<const texture::SurfacePoint> lying);
/// The same from the sources alone.
Result<WantedTexture> wanted_of(const FreeformJob& job);

/// The plan of a motion of `instants` instants.
Result<Plan> plan_of(const FreeformJob& job, const WantedTexture& wanted, std::int64_t instants);

/// A job with its motion and plan, ready to be compiled.
struct PlannedTexture {
  TextureOutcome outcome;
  WantedTexture wanted;
  Plan plan;
};
Result<PlannedTexture> plan_texture(const FreeformJob& job, Depth depth, const Command& command);

/// Writes the program; with the job file's text, and its sources, where there is one.
Result<CompiledPath> compile_texture(const FreeformJob& job, const PlannedTexture& planned, const std::string& output,
                                     const GrvOptions& grv);

}  // namespace gravure::cli
