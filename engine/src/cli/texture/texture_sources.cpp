// Surfaces and paths of the verbs of texture, out of files and expressions.

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "gravure/core/csv_rows.hpp"
#include "gravure/core/file_output.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/points.hpp"
#include "gravure/formats/svg.hpp"
#include "gravure/pipeline/layer_reader.hpp"
#include "gravure/texture/height_field.hpp"
#include "gravure/texture/mesh_surface.hpp"
#include "gravure/texture/planar_path.hpp"
#include "gravure/texture/stroke_path.hpp"
#include "texture/texture_options.hpp"

namespace gravure::cli {
namespace {

using texture::Vector2;

constexpr std::size_t kMostPathBytes = std::size_t{1} << 30U;
constexpr std::size_t kMostPoints = 1'500'000;  // a point takes some 900 bytes at the peak: 1.4 GB
constexpr double kPictureStep_um = 100;

std::string place_of(const TextureSettings& options, const std::string& file) {
  return (std::filesystem::path(options.folder) / file).lexically_normal().string();
}

Error named(const std::string& file, const Error& error) {
  return {error.code, file + ": " + error.message};
}

Result<std::vector<Vector2>> read_path(const std::string& file) {
  GRAVURE_TRY(const std::string text, read_file(file, kMostPathBytes));
  std::vector<Vector2> path;
  const Result<void> read = read_csv_rows(text, {"path", "x and y in mm, two numbers and no more", 2, "x_mm,y_mm"},
                                          [&path](std::span<const double> row) { path.emplace_back(row[0], row[1]); });
  if (!read) {
    return named(file, read.error());
  }
  return path;
}

Result<std::unique_ptr<texture::Surface>> height_field_of(const TextureSettings& options) {
  if (!options.pixel_um) {
    return Error{ErrorCode::bad_argument, "--pixel-um is missing: the side of the pixels of --height-field"};
  }
  const ImageFiles files;
  GRAVURE_TRY(const std::unique_ptr<ImageSource> picture, files.open(place_of(options, options.height_field), 0));
  texture::HeightScale scale;
  scale.pitch_x_mm = *options.pixel_um / kUmPerMm;
  scale.pitch_y_mm = options.pixel_y_um.value_or(*options.pixel_um) / kUmPerMm;
  if (options.height_mm.size() == 2) {
    scale.low_mm = options.height_mm[0];
    scale.high_mm = options.height_mm[1];
  } else if (picture->info().samples == SampleType::u16) {
    return Error{ErrorCode::bad_argument,
                 place_of(options, options.height_field) +
                     ": has 16 bits: give --height-mm ([surface] height_mm), z of sample 0 and of sample 65535"};
  }
  GRAVURE_TRY(texture::HeightGrid grid, texture::read_height_grid(*picture, scale));
  auto surface = texture::height_field_surface(std::move(grid));
  if (!surface) {
    return named(place_of(options, options.height_field), surface.error());
  }
  return surface;
}

Result<std::unique_ptr<texture::Surface>> mesh_of(const TextureSettings& options) {
  GRAVURE_TRY(const TriangleMesh mesh, read_triangle_mesh(place_of(options, options.mesh)));
  std::vector<texture::Vector3> vertices;
  vertices.reserve(mesh.vertices_mm.size());
  for (const Point3& each : mesh.vertices_mm) {
    vertices.emplace_back(each[0], each[1], each[2]);
  }
  auto surface = texture::mesh_surface(vertices, mesh.triangles);
  if (!surface) {
    return named(place_of(options, options.mesh), surface.error());
  }
  return surface;
}

/// The picture as a layer of a job on a cylinder.
Result<LayerStack> picture_stack(const TextureSettings& options, const ImageOpener& files) {
  const std::string file = place_of(options, options.bitmap);
  GRAVURE_TRY(const std::unique_ptr<ImageSource> picture, files.open(file, 0));
  const ImageInfo& info = picture->info();
  if (options.fires.empty()) {
    return Error{ErrorCode::bad_argument, "--fires is missing: which pixels of --bitmap fire, white or black"};
  }
  if ((info.samples != SampleType::bit) != options.threshold.has_value()) {
    return Error{ErrorCode::bad_argument,
                 file + (options.threshold ? ": is bilevel: leave --threshold ([texture] threshold) out"
                                           : ": is grey: give --threshold ([texture] threshold), the least sample "
                                             "that is white")};
  }
  LayerStack stack;
  stack.layers.push_back({file, 0, 0});
  stack.lines = info.height;
  stack.pixels = info.width;
  stack.samples = info.samples;
  stack.random_access = info.random_access;
  stack.fires = options.fires == "white" ? Fires::white : Fires::black;
  stack.threshold = options.threshold;
  stack.threshold_name = "--threshold";
  return stack;
}

texture::PictureGrid grid_of(const TextureSettings& options, const LayerStack& stack) {
  const double pitch_um = options.pitch_um.value_or(0);
  return {.columns = stack.pixels,
          .rows = stack.lines,
          .pixel_mm = pitch_um / kUmPerMm,
          .line_mm = options.line_pitch_um.value_or(pitch_um) / kUmPerMm,
          .run_out_mm = options.run_out_um / kUmPerMm,
          .step_mm = options.step_um.value_or(kPictureStep_um) / kUmPerMm};
}

Result<texture::TexturePath> drawing_path_of(const TextureSettings& options) {
  if (!options.step_um) {
    return Error{ErrorCode::bad_argument, "--step-um is missing: how far apart the points of the path are to be taken"};
  }
  const std::string file = place_of(options, options.svg);
  GRAVURE_TRY(const std::string text, read_file(file, kMostPathBytes));
  GRAVURE_TRY(const std::vector<SvgStroke> drawing, parse_svg(text, file, options.tolerance_um / kUmPerMm));
  std::vector<std::vector<Vector2>> strokes;
  for (const SvgStroke& each : drawing) {
    std::vector<Vector2>& stroke = strokes.emplace_back();
    for (const auto& [x, y] : each) {
      stroke.emplace_back(x, y);
    }
  }
  auto path = texture::stroke_path(strokes, *options.step_um / kUmPerMm, kMostPoints);
  if (!path) {
    return named(file, path.error());
  }
  return path;
}

Result<texture::TexturePath> file_path_of(const TextureSettings& options) {
  if (!options.step_um) {
    return Error{ErrorCode::bad_argument, "--step-um is missing: how far apart the points of the path are to be taken"};
  }
  texture::TexturePath path;
  path.step_mm = *options.step_um / kUmPerMm;
  GRAVURE_TRY(const std::vector<Vector2> corners, read_path(place_of(options, options.path)));
  auto points = texture::resample(corners, path.step_mm, kMostPoints);
  if (!points) {
    return named(place_of(options, options.path), points.error());
  }
  path.points_mm = std::move(points).value();
  return path;
}

}  // namespace

std::vector<std::string*> files_of(TextureSettings& options) {
  std::vector<std::string*> files;
  for (std::string* each : {&options.height_field, &options.mesh, &options.path, &options.svg, &options.bitmap}) {
    if (!each->empty()) {
      files.push_back(each);
    }
  }
  return files;
}

std::vector<std::string> inputs_of(TextureSettings options) {
  std::vector<std::string> inputs;
  for (const std::string* each : files_of(options)) {
    inputs.push_back(place_of(options, *each));
  }
  return inputs;
}

const std::string& surface_name(const TextureSettings& options) {
  return !options.surface.empty() ? options.surface : !options.mesh.empty() ? options.mesh : options.height_field;
}

std::string texture_name(const TextureSettings& options) {
  return !options.bitmap.empty() ? options.bitmap
         : !options.svg.empty()  ? options.svg
         : !options.path.empty() ? options.path
                                 : fmt::format("Hilbert curve of order {}", options.hilbert_order);
}

Result<std::unique_ptr<texture::Surface>> surface_of(const TextureSettings& options) {
  const int given = static_cast<int>(!options.surface.empty()) + static_cast<int>(!options.height_field.empty()) +
                    static_cast<int>(!options.mesh.empty());
  if (given != 1) {
    return Error{ErrorCode::bad_argument,
                 "give the surface as one of --surface EXPRESSION, --height-field FILE and --mesh FILE"};
  }
  auto surface = !options.surface.empty() ? texture::expression_surface(options.surface)
                 : !options.mesh.empty()  ? mesh_of(options)
                                          : height_field_of(options);
  if (!surface) {
    return surface.error();
  }
  return texture::limit_slope(std::move(surface).value(), options.max_slope_deg / kDegreesPerRad);
}

Result<texture::PictureGrid> picture_grid_of(const TextureSettings& options) {
  if (!options.pitch_um) {
    return Error{ErrorCode::bad_argument, "--pitch-um is missing: how far apart the pixels of --bitmap are"};
  }
  const ImageFiles files;
  GRAVURE_TRY(const LayerStack stack, picture_stack(options, files));
  return grid_of(options, stack);
}

Result<PathPulses> picture_pulses_of(const TextureSettings& options) {
  const ImageFiles files;
  GRAVURE_TRY(const LayerStack stack, picture_stack(options, files));
  LayerReader lines(stack, files, 0);
  return texture::picture_pulses(grid_of(options, stack), lines, cancel_token());
}

Result<texture::TexturePath> path_of(const TextureSettings& options) {
  const int given = static_cast<int>(options.hilbert_order != 0) + static_cast<int>(!options.path.empty()) +
                    static_cast<int>(!options.svg.empty()) + static_cast<int>(!options.bitmap.empty());
  if (given != 1) {
    return Error{ErrorCode::bad_argument,
                 "give the path as one of --hilbert-order N, --path FILE.csv, --svg FILE and --bitmap FILE"};
  }
  if (!options.bitmap.empty()) {
    GRAVURE_TRY(const texture::PictureGrid grid, picture_grid_of(options));
    return texture::picture_path(grid, kMostPoints);
  }
  if (!options.svg.empty()) {
    return drawing_path_of(options);
  }
  if (!options.path.empty()) {
    return file_path_of(options);
  }
  if (options.step_um) {
    return Error{ErrorCode::bad_argument, "--step-um: the points of a Hilbert curve are its own; leave it out"};
  }
  texture::TexturePath path;
  GRAVURE_TRY(path.points_mm, texture::hilbert_curve(options.hilbert_order, options.size_mm));
  path.step_mm = (path.points_mm[1] - path.points_mm[0]).norm();
  return path;
}

}  // namespace gravure::cli
