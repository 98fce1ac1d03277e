#include "triangle_grid.hpp"

#include <algorithm>
#include <cmath>

namespace gravure::texture {

TriangleGrid::TriangleGrid(std::span<const Vector3> vertices_mm,
                           std::span<const std::array<std::uint32_t, 3>> triangles) {
  low_mm_ = high_mm_ = vertices_mm[triangles[0][0]].head<2>();
  for (const auto& triangle : triangles) {
    for (const std::uint32_t corner : triangle) {
      low_mm_ = low_mm_.cwiseMin(vertices_mm[corner].head<2>());
      high_mm_ = high_mm_.cwiseMax(vertices_mm[corner].head<2>());
    }
  }
  const Vector2 size_mm = high_mm_ - low_mm_;
  const auto count = static_cast<double>(triangles.size());
  // A long and narrow mesh still gets no more than `count` cells along its longer side.
  side_mm_ = std::max(std::sqrt(size_mm.x() * size_mm.y() / count), size_mm.maxCoeff() / count);
  constexpr std::uint64_t kMostPerTriangle = 32;
  for (;; side_mm_ *= 2) {
    columns_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(size_mm.x() / side_mm_)));
    rows_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(size_mm.y() / side_mm_)));
    std::uint64_t places = 0;
    for (const auto& triangle : triangles) {
      const Cells in = cells_of(vertices_mm, triangle);
      places += static_cast<std::uint64_t>((in.right - in.left + 1) * (in.upper - in.lower + 1));
    }
    if (places <= kMostPerTriangle * triangles.size() || columns_ * rows_ == 1) {
      break;
    }
  }
  starts_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  const auto each_cell = [&](const auto& use) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const Cells in = cells_of(vertices_mm, triangles[i]);
      for (std::int64_t row = in.lower; row <= in.upper; ++row) {
        for (std::int64_t column = in.left; column <= in.right; ++column) {
          use(static_cast<std::size_t>(row * columns_ + column), static_cast<std::uint32_t>(i));
        }
      }
    }
  };
  each_cell([this](std::size_t cell, std::uint32_t) { ++starts_[cell + 1]; });
  for (std::size_t i = 1; i < starts_.size(); ++i) {
    starts_[i] += starts_[i - 1];
  }
  found_.resize(starts_.back());
  std::vector<std::uint64_t> next(starts_.begin(), starts_.end() - 1);
  each_cell([this, &next](std::size_t cell, std::uint32_t triangle) { found_[next[cell]++] = triangle; });
}

std::int64_t TriangleGrid::cell(double place_mm, double low_mm, std::int64_t count) const {
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor((place_mm - low_mm) / side_mm_)), 0, count - 1);
}

TriangleGrid::Cells TriangleGrid::cells_of(std::span<const Vector3> vertices_mm,
                                           const std::array<std::uint32_t, 3>& triangle) const {
  const auto [a, b, c] = triangle;
  const Vector2 low = vertices_mm[a].cwiseMin(vertices_mm[b]).cwiseMin(vertices_mm[c]).head<2>();
  const Vector2 high = vertices_mm[a].cwiseMax(vertices_mm[b]).cwiseMax(vertices_mm[c]).head<2>();
  return {cell(low.x(), low_mm_.x(), columns_), cell(high.x(), low_mm_.x(), columns_),
          cell(low.y(), low_mm_.y(), rows_), cell(high.y(), low_mm_.y(), rows_)};
}

std::span<const std::uint32_t> TriangleGrid::at(const Vector2& plane_mm) const {
  if (!((plane_mm.array() >= low_mm_.array()).all() && (plane_mm.array() <= high_mm_.array()).all())) {
    return {};
  }
  const auto index = static_cast<std::size_t>(cell(plane_mm.y(), low_mm_.y(), rows_) * columns_ +
                                              cell(plane_mm.x(), low_mm_.x(), columns_));
  return std::span(found_).subspan(starts_[index], starts_[index + 1] - starts_[index]);
}

}  // namespace gravure::texture
