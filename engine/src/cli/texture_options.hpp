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
#include "gravure/texture/axes.hpp"
#include "gravure/texture/picture_path.hpp"
#include "gravure/texture/split.hpp"
#include "gravure/texture/splitter.hpp"
#include "motion_options.hpp"
#include "text_output.hpp"
#include "verb.hpp"

namespace gravure::cli {

inline constexpr double kDegreesPerRad = 180 / std::numbers::pi;
inline constexpr double kUmPerMm = 1000;

/// To 1e-9 of its unit: what is less depends on the compiler.
double figure(double value);

/// An option for a length or angle above 0.
template <class Number>
CLI::Option* add_length(CLI::App& verb, const std::string& name, Number& number, double most, const std::string& text) {
  constexpr double kLeast = 1e-6;
  return verb.add_option(name, number, text)->check(number_from(kLeast, most));
}

/// The surface and the path on it.
struct TextureOptions {
  std::string surface;
  std::string height_field;
  std::optional<double> pixel_um;
  std::optional<double> pixel_y_um;
  std::vector<double> height_mm;  ///< of the smallest and of the largest sample
  std::string mesh;
  double max_slope_deg = 80;
  int hilbert_order = 0;
  double size_mm = 40;
  std::string path;
  std::string svg;
  double tolerance_um = 1;
  std::string bitmap;
  std::optional<double> pitch_um;
  std::optional<double> line_pitch_um;
  double run_out_um = 500;
  std::string fires;
  std::optional<std::int64_t> threshold;
  std::optional<double> step_um;
};
void add_texture_options(CLI::App& verb, TextureOptions& options);
/// Files that are read: no output may be one of them.
std::vector<std::string> inputs_of(const TextureOptions& options);
/// What to call the surface: its expression, or its file.
const std::string& surface_name(const TextureOptions& options);
/// One of an expression, a height field or a mesh; project() refuses what is too steep.
Result<std::unique_ptr<texture::Surface>> surface_of(const TextureOptions& options);
/// The path, its points a fixed length apart.
Result<texture::TexturePath> path_of(const TextureOptions& options);
/// The pixels of --bitmap in the plane, and the pulses of all of them.
Result<texture::PictureGrid> picture_grid_of(const TextureOptions& options);
Result<PathPulses> picture_pulses_of(const TextureOptions& options);

/// How the path is split between stages and galvo.
struct SplitOptions {
  std::string method = "gaussian";
  bool focus_axis = false;  ///< takes up the focus offset: no limit for it
  std::optional<double> sigma_um;
  double cut = 8;
  double fod_um = 100;
  double bia_deg = 10;
  double displacement_mm = 5;
};
/// `without_sigma`: what is done where --sigma-um is left out.
void add_split_options(CLI::App& verb, SplitOptions& options, const std::string& without_sigma);
texture::DeviationLimits limits_of(const SplitOptions& options);
std::unique_ptr<texture::Splitter> splitter_of(const SplitOptions& options);

/// How the machine stands and how the workpiece lies in it.
struct AxesOptions {
  std::string branch = "positive";
  std::string signs = "texturing";
  std::vector<double> origin_mm = {0, 0, 0};
  std::vector<double> tilt_deg = {0, 0};
};
void add_axes_options(CLI::App& verb, AxesOptions& options);
/// The axes of a split, which is laid into its clamping for that.
Result<std::vector<texture::SevenAxes>> axes_of(const AxesOptions& options, const texture::Split& split);

/// The columns that every verb's --points has: i,x,y,z,xp,yp,zp,X,Y,Z,A,C,U,V,fod_um,bia_deg; W behind them where
/// there is an axis for it.
Result<void> write_points(const std::string& file, const texture::Split& split,
                          std::span<const texture::SevenAxes> axes, bool focus_axis = false);

/// surface, points, step_um, sigma_um, tries, fod_um, bia_deg and displacement_mm as all verbs print them.
Json split_json(const std::string& surface, const texture::TexturePath& path, const texture::Split& split);
/// The same as lines for people; `how_sigma` stands behind sigma.
std::string split_text(const texture::TexturePath& path, const texture::Split& split, const SplitOptions& options,
                       const std::string& how_sigma);

}  // namespace gravure::cli
