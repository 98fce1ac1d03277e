#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gravure/texture/surface.hpp"

namespace gravure::texture {

/// Which triangles may lie above or below a point of the plane: a grid of cells with the triangles whose box meets
/// each. About as many cells as triangles; fewer where large triangles would stand in too many of them.
class TriangleGrid {
 public:
  TriangleGrid(std::span<const Vector3> vertices_mm, std::span<const std::array<std::uint32_t, 3>> triangles);
  /// In the order of the triangles; none outside of their box.
  std::span<const std::uint32_t> at(const Vector2& plane_mm) const;
  const Vector2& low_mm() const noexcept { return low_mm_; }
  const Vector2& high_mm() const noexcept { return high_mm_; }

 private:
  struct Cells {
    std::int64_t left, right, lower, upper;  ///< all of them inclusive
  };
  Cells cells_of(std::span<const Vector3> vertices_mm, const std::array<std::uint32_t, 3>& triangle) const;
  std::int64_t cell(double place_mm, double low_mm, std::int64_t count) const;

  Vector2 low_mm_ = Vector2::Zero();
  Vector2 high_mm_ = Vector2::Zero();
  double side_mm_ = 0;
  std::int64_t columns_ = 0;
  std::int64_t rows_ = 0;
  std::vector<std::uint64_t> starts_;  ///< of each cell in `found_`, and the end
  std::vector<std::uint32_t> found_;
};

}  // namespace gravure::texture
