#include "gravure/texture/planar_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gravure::texture {
namespace {

constexpr int kMostOrder = 12;

/// The cell of place `index` along the curve; the usual rotation of quadrants from the smallest up.
std::pair<std::uint32_t, std::uint32_t> hilbert_cell(std::uint32_t index, int order) {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  for (std::uint32_t side = 1; side < (1U << static_cast<unsigned>(order)); side *= 2, index /= 4) {
    const std::uint32_t right = (index / 2) & 1U;
    const std::uint32_t up = (index ^ right) & 1U;
    if (up == 0) {
      if (right == 1) {
        x = side - 1 - x;
        y = side - 1 - y;
      }
      std::swap(x, y);
    }
    x += side * right;
    y += side * up;
  }
  return {x, y};
}

}  // namespace

Result<std::vector<Vector2>> hilbert_curve(int order, double size_mm) {
  if (order < 1 || order > kMostOrder) {
    return Error{ErrorCode::out_of_range, fmt::format("Hilbert order {}: must be 1 to {}", order, kMostOrder)};
  }
  if (!(size_mm > 0) || !std::isfinite(size_mm)) {
    return Error{ErrorCode::out_of_range, fmt::format("Hilbert curve of {} mm: must be above 0", size_mm)};
  }
  const std::uint32_t side = 1U << static_cast<unsigned>(order);
  const double pitch_mm = size_mm / (side - 1);
  std::vector<Vector2> points(std::size_t{side} * side);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto [x, y] = hilbert_cell(i, order);
    points[i] = Vector2(x * pitch_mm - size_mm / 2, y * pitch_mm - size_mm / 2);
  }
  return points;
}

std::vector<double> arc_lengths_mm(std::span<const Vector2> path_mm) {
  std::vector<double> lengths(path_mm.size(), 0.0);
  for (std::size_t i = 1; i < path_mm.size(); ++i) {
    lengths[i] = lengths[i - 1] + (path_mm[i] - path_mm[i - 1]).norm();
  }
  return lengths;
}

Result<std::vector<Vector2>> resample(std::span<const Vector2> path_mm, double step_mm, std::size_t most_points) {
  if (path_mm.size() < 2) {
    return Error{ErrorCode::bad_argument, fmt::format("a path of {} points: must have two or more", path_mm.size())};
  }
  const std::vector<double> lengths = arc_lengths_mm(path_mm);
  if (lengths.back() == 0) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("a path of {} points that are all the same, ({}, {}) mm: must have two different ones",
                             path_mm.size(), path_mm[0].x(), path_mm[0].y())};
  }
  const double cells = lengths.back() / step_mm;
  if (!(step_mm > 0) || !(cells < static_cast<double>(most_points))) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("a path of {} mm in steps of {} mm: must be above 0 and at most {} points", lengths.back(),
                             step_mm, most_points)};
  }
  std::vector<Vector2> points;
  points.reserve(static_cast<std::size_t>(cells) + 2);
  std::size_t segment = 1;
  for (std::size_t i = 0; static_cast<double>(i) * step_mm < lengths.back(); ++i) {
    const double at_mm = static_cast<double>(i) * step_mm;
    while (segment + 1 < path_mm.size() && lengths[segment] <= at_mm) {
      ++segment;
    }
    const double length_mm = lengths[segment] - lengths[segment - 1];
    const double share = length_mm > 0 ? (at_mm - lengths[segment - 1]) / length_mm : 0.0;
    points.emplace_back(path_mm[segment - 1] + share * (path_mm[segment] - path_mm[segment - 1]));
  }
  points.push_back(path_mm.back());
  return points;
}

}  // namespace gravure::texture
