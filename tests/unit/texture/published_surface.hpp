#pragma once

#include <memory>
#include <vector>

#include "gravure/texture/planar_path.hpp"
#include "gravure/texture/surface.hpp"

namespace gravure::texture::test {

/// The stated surface: convex, concave and saddle, 10.40 mm high over 50 x 50 mm.
inline std::unique_ptr<Surface> published_surface() {
  return expression_surface("2.6 * (cos(2*pi*x/39 + 0.3) + cos(2*pi*y/39 + 1.1))").value();
}

inline std::vector<SurfacePoint> on(const Surface& surface, const std::vector<Vector2>& plane_mm) {
  std::vector<SurfacePoint> points(plane_mm.size());
  const Result<void> projected = surface.project(plane_mm, points);
  return projected ? points : std::vector<SurfacePoint>();
}

}  // namespace gravure::texture::test
