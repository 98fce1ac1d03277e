#include "texture_options.hpp"

#include <fmt/format.h>

#include <cmath>

#include "gravure/core/csv_rows.hpp"
#include "gravure/core/file_output.hpp"
#include "gravure/texture/planar_path.hpp"

namespace gravure::cli {
namespace {

using texture::Vector2;

constexpr std::size_t kMostPathBytes = std::size_t{1} << 30U;
constexpr std::int64_t kMostHilbertOrder = 10;
constexpr std::size_t kMostPoints = 1'500'000;  // a point takes some 150 bytes at the peak

Result<std::vector<Vector2>> read_path(const std::string& file) {
  GRAVURE_TRY(const std::string text, read_file(file, kMostPathBytes));
  std::vector<Vector2> path;
  const Result<void> read = read_csv_rows(text, {"path", "x and y in mm, two numbers and no more", 2, "x_mm,y_mm"},
                                          [&path](std::span<const double> row) { path.emplace_back(row[0], row[1]); });
  if (!read) {
    return Error{read.error().code, file + ": " + read.error().message};
  }
  return path;
}

}  // namespace

double figure(double value) {
  return std::round(value * 1e9) / 1e9 + 0.0;
}

void add_texture_options(CLI::App& verb, TextureOptions& options) {
  verb.add_option("--surface", options.surface, "z in mm by x and y in mm: + - * / ^, sin, cos, exp, sqrt, pi ...")
      ->required();
  verb.add_option("--hilbert-order", options.hilbert_order, "Hilbert curve of 4^N points as path")
      ->check(integer_from(1, kMostHilbertOrder));
  add_length(verb, "--size-mm", options.size_mm, 1e6, "Side of the square of that curve")->capture_default_str();
  verb.add_option("--path", options.path, "Path from a file: CSV with x_mm, y_mm, a corner a line");
  add_length(verb, "--step-um", options.step_um, 1e9, "Distance of the points along --path");
}

Result<texture::TexturePath> path_of(const TextureOptions& options) {
  if (options.path.empty() == (options.hilbert_order == 0)) {
    return Error{ErrorCode::bad_argument, "give the path either as --hilbert-order N or as --path FILE.csv"};
  }
  texture::TexturePath path;
  if (options.hilbert_order != 0) {
    if (options.step_um) {
      return Error{ErrorCode::bad_argument, "--step-um: the points of a Hilbert curve are its own; leave it out"};
    }
    GRAVURE_TRY(path.points_mm, texture::hilbert_curve(options.hilbert_order, options.size_mm));
    path.step_mm = (path.points_mm[1] - path.points_mm[0]).norm();
    return path;
  }
  if (!options.step_um) {
    return Error{ErrorCode::bad_argument, "--step-um is missing: how far apart the points of the path are to be taken"};
  }
  path.step_mm = *options.step_um / kUmPerMm;
  GRAVURE_TRY(const std::vector<Vector2> corners, read_path(options.path));
  auto points = texture::resample(corners, path.step_mm, kMostPoints);
  if (!points) {
    return Error{points.error().code, options.path + ": " + points.error().message};
  }
  path.points_mm = std::move(points).value();
  return path;
}

void add_split_options(CLI::App& verb, SplitOptions& options, const std::string& without_sigma) {
  add_length(verb, "--sigma-um", options.sigma_um, 1e9,
             "Sigma of the Gaussian along the path; left out: " + without_sigma);
  add_length(verb, "--cut", options.cut, 38, "Where the Gaussian ends, in sigma")->capture_default_str();
  add_length(verb, "--fod-um", options.fod_um, 1e9, "Limit of the focus offset")->capture_default_str();
  add_length(verb, "--bia-deg", options.bia_deg, 90, "Limit of the angle of incidence")->capture_default_str();
  add_length(verb, "--displacement-mm", options.displacement_mm, 1e6, "Limit of what the galvo reaches")
      ->capture_default_str();
}

texture::DeviationLimits limits_of(const SplitOptions& options) {
  return {options.fod_um / kUmPerMm, options.bia_deg / kDegreesPerRad, options.displacement_mm};
}

Result<void> write_points(const std::string& file, const texture::Split& split,
                          std::span<const texture::SevenAxes> axes) {
  GRAVURE_TRY(TextOutput output, TextOutput::create(file));
  output.text() += "i,x,y,z,xp,yp,zp,X,Y,Z,A,C,U,V,fod_um,bia_deg\n";
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto& p = split.targets[i].position_mm;
    const auto& q = split.stages[i].position_mm;
    const texture::SevenAxes& at = axes[i];
    const texture::Deviation off = texture::deviation(split.targets[i], split.stages[i]);
    output.text() += fmt::format(
        "{},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.12f},{:.12f},{:.9f},"
        "{:.9f},{:.6f},{:.9f}\n",
        i, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), at.x_mm, at.y_mm, at.z_mm, at.a_rad, at.c_rad, at.u_mm, at.v_mm,
        off.focus_mm * kUmPerMm, off.incidence_rad * kDegreesPerRad);
    if (!output.flush(false) || cancel_token().cancelled()) {
      break;
    }
  }
  if (cancel_token().cancelled()) {
    return Error{ErrorCode::cancelled, "stopped; nothing was written"};
  }
  return output.commit();
}

Json split_json(const std::string& surface, const texture::TexturePath& path, const texture::Split& split) {
  const texture::DeviationSummary& most = split.most;
  return {{"surface", surface},
          {"points", split.targets.size()},
          {"step_um", figure(path.step_mm * kUmPerMm)},
          {"sigma_um", figure(split.sigma_mm * kUmPerMm)},
          {"tries", split.tries},
          {"fod_um", {{"max", figure(most.max_focus_mm * kUmPerMm)}, {"rms", figure(most.rms_focus_mm * kUmPerMm)}}},
          {"bia_deg", {{"max", figure(most.max_incidence_rad * kDegreesPerRad)}}},
          {"displacement_mm", {{"max", figure(most.max_displacement_mm)}}}};
}

std::string split_text(const texture::TexturePath& path, const texture::Split& split, const SplitOptions& options,
                       const std::string& how_sigma) {
  const texture::DeviationSummary& most = split.most;
  const double length_mm = static_cast<double>(path.points_mm.size() - 1) * path.step_mm;
  std::string text = fmt::format("path          {} points, {:.6g} um apart, {:.6g} m in the plane\n",
                                 split.targets.size(), path.step_mm * kUmPerMm, length_mm / 1000);
  text += fmt::format("sigma         {:.3f} um of arc length{}\n", split.sigma_mm * kUmPerMm, how_sigma);
  text += fmt::format("focus offset  {:.3f} um at most, {:.3f} um rms (allowed {:.6g})\n", most.max_focus_mm * kUmPerMm,
                      most.rms_focus_mm * kUmPerMm, options.fod_um);
  text += fmt::format("incidence     {:.5f} deg at most (allowed {:.6g})\n", most.max_incidence_rad * kDegreesPerRad,
                      options.bia_deg);
  text += fmt::format("galvo         {:.6f} mm at most (allowed {:.6g})\n", most.max_displacement_mm,
                      options.displacement_mm);
  return text;
}

}  // namespace gravure::cli
