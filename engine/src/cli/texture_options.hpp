#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gravure/texture/axes.hpp"
#include "gravure/texture/split.hpp"
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
  int hilbert_order = 0;
  double size_mm = 40;
  std::string path;
  std::optional<double> step_um;
};
void add_texture_options(CLI::App& verb, TextureOptions& options);
/// The path, its points a fixed length apart.
Result<texture::TexturePath> path_of(const TextureOptions& options);

/// How the path is split between stages and galvo.
struct SplitOptions {
  std::optional<double> sigma_um;
  double cut = 8;
  double fod_um = 100;
  double bia_deg = 10;
  double displacement_mm = 5;
};
/// `without_sigma`: what is done where --sigma-um is left out.
void add_split_options(CLI::App& verb, SplitOptions& options, const std::string& without_sigma);
texture::DeviationLimits limits_of(const SplitOptions& options);

/// The columns that every verb's --points has: i,x,y,z,xp,yp,zp,X,Y,Z,A,C,U,V,fod_um,bia_deg.
Result<void> write_points(const std::string& file, const texture::Split& split,
                          std::span<const texture::SevenAxes> axes);

/// surface, points, step_um, sigma_um, tries, fod_um, bia_deg and displacement_mm as all verbs print them.
Json split_json(const std::string& surface, const texture::TexturePath& path, const texture::Split& split);
/// The same as lines for people; `how_sigma` stands behind sigma.
std::string split_text(const texture::TexturePath& path, const texture::Split& split, const SplitOptions& options,
                       const std::string& how_sigma);

}  // namespace gravure::cli
