#include "gravure/texture/picture_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "gravure/raster/place.hpp"

namespace gravure::texture {
namespace {

constexpr std::int64_t kMostPixels = std::int64_t{1} << 33;

Result<void> check(const PictureGrid& grid) {
  const bool lengths = grid.pixel_mm > 0 && grid.line_mm > 0 && grid.step_mm > 0 && grid.run_out_mm >= 0;
  if (grid.columns < 1 || grid.rows < 1 || !lengths || !std::isfinite(grid.pixel_mm + grid.line_mm + grid.run_out_mm)) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("picture of {} x {} pixels of {} x {} mm, points {} mm apart, run-out {} mm: all but the "
                             "run-out must be above 0",
                             grid.columns, grid.rows, grid.pixel_mm, grid.line_mm, grid.step_mm, grid.run_out_mm)};
  }
  if (grid.columns > kMostPixels / grid.rows) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("picture of {} x {} pixels: at most {} are taken", grid.columns, grid.rows, kMostPixels)};
  }
  return {};
}

double width_mm(const PictureGrid& grid) {
  return static_cast<double>(grid.columns) * grid.pixel_mm;
}

double row_y_mm(const PictureGrid& grid, std::int64_t row) {
  return (static_cast<double>(grid.rows - 1) / 2 - static_cast<double>(row)) * grid.line_mm;
}

}  // namespace

Result<TexturePath> picture_path(const PictureGrid& grid, std::size_t most_points) {
  GRAVURE_CHECK(check(grid));
  const double line_steps = std::ceil(width_mm(grid) / grid.step_mm);
  TexturePath path;
  path.step_mm = width_mm(grid) / line_steps;
  const double out_steps = std::ceil(grid.run_out_mm / path.step_mm);
  const double down_steps = std::max(1.0, std::round(grid.line_mm / path.step_mm));
  const double points = (line_steps + 2 * out_steps + down_steps) * static_cast<double>(grid.rows);
  if (!(points < static_cast<double>(most_points))) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("picture: {:.0f} points {} mm apart make its path, at most {} are taken: put them further "
                             "apart",
                             points, path.step_mm, most_points)};
  }
  const auto across = static_cast<std::int64_t>(line_steps);
  const auto out = static_cast<std::int64_t>(out_steps);
  const auto down = static_cast<std::int64_t>(down_steps);
  path.points_mm.reserve(static_cast<std::size_t>(points) + 1);
  path.pulse_mm.reserve(path.points_mm.capacity());
  for (std::int64_t row = 0; row < grid.rows; ++row) {
    const double way = row % 2 == 0 ? 1 : -1;
    const double y = row_y_mm(grid, row);
    for (std::int64_t i = -out; i <= across + out; ++i) {
      const double x = way * (static_cast<double>(i) * path.step_mm - width_mm(grid) / 2);
      const auto lit = static_cast<double>(std::clamp<std::int64_t>(i, 0, across));
      path.points_mm.emplace_back(x, y);
      path.pulse_mm.push_back((static_cast<double>(row) + lit / line_steps) * width_mm(grid));
    }
    for (std::int64_t i = 1; i < down && row + 1 < grid.rows; ++i) {
      path.points_mm.emplace_back(path.points_mm.back().x(), y - grid.line_mm * static_cast<double>(i) / down_steps);
      path.pulse_mm.push_back(path.pulse_mm.back());
    }
  }
  return path;
}

Result<PathPulses> picture_pulses(const PictureGrid& grid, LayerLines& lines, const CancelToken& cancel) {
  GRAVURE_CHECK(check(grid));
  PathPulses pulses{grid.pixel_mm, grid.columns * grid.rows, {}};
  pulses.bits.resize(static_cast<std::size_t>(raster::packed_bytes(pulses.count)));
  const std::int64_t bytes = raster::packed_bytes(grid.columns);
  const std::int64_t band = std::clamp<std::int64_t>((std::int64_t{1} << 20) / bytes, 1, grid.rows);
  std::vector<std::byte> read(static_cast<std::size_t>(band * bytes));
  for (std::int64_t first = 0; first < grid.rows; first += band) {
    if (cancel.cancelled()) {
      return Error{ErrorCode::cancelled, "stopped while the picture was read"};
    }
    const std::int64_t now = std::min(band, grid.rows - first);
    const auto size = static_cast<std::size_t>(now * bytes);
    GRAVURE_TRY(const bool dark, lines.read_lines(0, first, now, std::span(read).first(size)));
    for (std::int64_t row = 0; row < now; ++row) {
      raster::place_line(pulses.bits, (first + row) * grid.columns,
                         std::span(read).subspan(static_cast<std::size_t>(row * bytes)), 0, grid.columns,
                         {.mirror = (first + row) % 2 != 0, .invert = dark});
    }
  }
  return pulses;
}

Pixel pixel_of(const PictureGrid& grid, std::int64_t pulse) {
  const std::int64_t row = pulse / grid.columns;
  const std::int64_t along = pulse % grid.columns;
  return {row, row % 2 == 0 ? along : grid.columns - 1 - along};
}

Vector2 pixel_mm(const PictureGrid& grid, const Pixel& pixel) {
  return {(static_cast<double>(pixel.column) + 0.5) * grid.pixel_mm - width_mm(grid) / 2, row_y_mm(grid, pixel.row)};
}

}  // namespace gravure::texture
