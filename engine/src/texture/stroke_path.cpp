#include "gravure/texture/stroke_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gravure/texture/planar_path.hpp"

namespace gravure::texture {
namespace {

/// Appends points along a polyline, its first point left out.
Result<void> append(TexturePath& path, std::span<const Vector2> piece_mm, bool dark, std::size_t most_points) {
  const std::vector<double> lengths_mm = arc_lengths_mm(piece_mm);
  if (lengths_mm.back() <= 0) {
    return {};
  }
  const double steps = std::max(1.0, std::round(lengths_mm.back() / path.step_mm));
  if (!(steps < static_cast<double>(most_points - path.points_mm.size()))) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("strokes in steps of {} mm: at most {} points are taken", path.step_mm, most_points)};
  }
  std::size_t segment = 1;
  for (double i = 1; i < steps; ++i) {
    const double at_mm = lengths_mm.back() * (i / steps);
    while (segment + 1 < piece_mm.size() && lengths_mm[segment] <= at_mm) {
      ++segment;
    }
    const double share = (at_mm - lengths_mm[segment - 1]) / (lengths_mm[segment] - lengths_mm[segment - 1]);
    path.points_mm.emplace_back(piece_mm[segment - 1] + share * (piece_mm[segment] - piece_mm[segment - 1]));
  }
  path.points_mm.push_back(piece_mm.back());
  path.dark.resize(path.points_mm.size(), dark);
  return {};
}

}  // namespace

Result<TexturePath> stroke_path(std::span<const std::vector<Vector2>> strokes_mm, double step_mm,
                                std::size_t most_points) {
  if (!(step_mm > 0) || strokes_mm.empty() || most_points == 0) {
    return Error{
        ErrorCode::bad_argument,
        fmt::format("{} strokes in steps of {} mm: there must be one, in steps above 0", strokes_mm.size(), step_mm)};
  }
  Vector2 low = Vector2::Constant(HUGE_VAL);
  Vector2 high = -low;
  for (const std::vector<Vector2>& stroke : strokes_mm) {
    if (stroke.size() < 2) {
      return Error{ErrorCode::bad_argument, "a stroke of fewer than two points"};
    }
    for (const Vector2& point : stroke) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
  }
  TexturePath path;
  path.step_mm = step_mm;
  path.points_mm.push_back(strokes_mm.front().front());
  path.dark.push_back(false);
  for (const std::vector<Vector2>& stroke : strokes_mm) {
    GRAVURE_CHECK(append(path, std::vector<Vector2>{path.points_mm.back(), stroke.front()}, true, most_points));
    GRAVURE_CHECK(append(path, stroke, false, most_points));
  }
  const Vector2 centre = (low + high) / 2;
  for (Vector2& point : path.points_mm) {
    point -= centre;
  }
  return path;
}

}  // namespace gravure::texture
