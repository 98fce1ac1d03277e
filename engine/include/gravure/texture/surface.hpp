#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::texture {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;

/// A point of a surface z = f(x, y), with the normal that points to the side of the head.
struct SurfacePoint {
  Vector3 position_mm = Vector3::Zero();
  Vector3 normal = Vector3::UnitZ();  ///< (-f_x, -f_y, 1) / length, [A] eq. 2
};

/// A surface over the x-y plane, onto which a texture is projected along z ([A] eq. 1).
class Surface {
 public:
  virtual ~Surface() = default;
  /// The points above (or below) points of the plane, `out` as long as `plane_mm`. out_of_range, naming the first
  /// point, where the surface has none or its slope is beyond what a normal can be given for.
  virtual Result<void> project(std::span<const Vector2> plane_mm, std::span<SurfacePoint> out) const = 0;
};

/// z in mm as an expression in x and y (mm): + - * / ^, cos, sin, exp, sqrt and the other functions of muParser, pi.
/// Slopes are central differences of fourth order. bad_argument, with the place, for what does not parse.
Result<std::unique_ptr<Surface>> expression_surface(const std::string& expression);

/// The same surface; project() fails with out_of_range, naming point and slope, where it is steeper, or where it is
/// more than 10 m above or below z = 0.
std::unique_ptr<Surface> limit_slope(std::unique_ptr<Surface> surface, double most_rad);

}  // namespace gravure::texture
