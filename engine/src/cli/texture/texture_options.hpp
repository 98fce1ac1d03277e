#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/path_motion.hpp"
#include "gravure/core/units.hpp"
#include "gravure/formats/freeform_job.hpp"
#include "gravure/texture/axes.hpp"
#include "gravure/texture/clamping.hpp"
#include "gravure/texture/picture_path.hpp"
#include "gravure/texture/split.hpp"
#include "gravure/texture/splitter.hpp"
#include "motion/motion_options.hpp"
#include "text_output.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// To 1e-9 of its unit: what is less depends on the compiler.
double figure(double value);

/// An option for a length or angle above 0.
template <class Number>
CLI::Option* add_length(CLI::App& verb, const std::string& name, Number& number, double most, const std::string& text) {
  constexpr double kLeast = 1e-6;
  return verb.add_option(name, number, text)->check(number_from(kLeast, most));
}

void add_texture_options(CLI::App& verb, TextureSettings& options);
/// The names of the files that are read, the surface's first.
std::vector<std::string*> files_of(TextureSettings& options);
/// Where they lie: no output may be one of them.
std::vector<std::string> inputs_of(TextureSettings options);
/// What to call the surface: its expression, or its file.
const std::string& surface_name(const TextureSettings& options);
std::string texture_name(const TextureSettings& options);
/// One of an expression, a height field or a mesh; project() refuses what is too steep.
Result<std::unique_ptr<texture::Surface>> surface_of(const TextureSettings& options);
/// The path, its points a fixed length apart.
Result<texture::TexturePath> path_of(const TextureSettings& options);
/// The pixels of --bitmap in the plane, and the pulses of all of them.
Result<texture::PictureGrid> picture_grid_of(const TextureSettings& options);
Result<PathPulses> picture_pulses_of(const TextureSettings& options);

/// `without_sigma`: what is done where --sigma-um is left out.
void add_split_options(CLI::App& verb, SplitSettings& options, const std::string& without_sigma);
texture::DeviationLimits limits_of(const SplitSettings& options);
std::unique_ptr<texture::Splitter> splitter_of(const SplitSettings& options);

void add_axes_options(CLI::App& verb, AxesSettings& options);
texture::Clamping clamping_of(const AxesSettings& options);
kinematics::Machine machine_of(const AxesSettings& options);
kinematics::Branch branch_of(const AxesSettings& options);
/// The axes of a split, which is laid into its clamping for that.
Result<std::vector<texture::SevenAxes>> axes_of(const AxesSettings& options, const texture::Split& split);

/// How sigma is chosen where it is not given, where the spot rests, what the axes can do, servo period. Limits are
/// gathered as text: "X=100,200,300".
void add_motion_options(CLI::App& verb, FreeformJob& job, std::vector<std::string>& limits);
Result<void> set_limits(const std::vector<std::string>& limits, MotionSettings& motion);

/// The columns that every verb's --points has: i,x,y,z,xp,yp,zp,X,Y,Z,A,C,U,V,fod_um,bia_deg; W behind them where
/// there is an axis for it. Whoever asked puts the file in its place, after the others; none for an empty path.
Result<std::optional<TextOutput>> stage_points(const std::string& file, const texture::Split& split,
                                               std::span<const texture::SevenAxes> axes, bool focus_axis);
/// Writes what a staged file still holds back; io where that fails.
Result<std::optional<TextOutput>> staged(TextOutput output, const std::string& file);
void add_points_option(CLI::App& verb, std::string& file);

/// surface, split, points, step_um, sigma_um, tries, fod_um, bia_deg and displacement_mm as all verbs print them.
Json split_json(const std::string& surface, const texture::TexturePath& path, const texture::Split& split,
                const SplitSettings& options);
/// The same as lines for people; `how_sigma` stands behind sigma.
std::string split_text(const texture::TexturePath& path, const texture::Split& split, const SplitSettings& options,
                       const std::string& how_sigma);

}  // namespace gravure::cli
