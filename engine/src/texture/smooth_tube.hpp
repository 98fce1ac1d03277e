#pragma once

#include <array>
#include <span>
#include <vector>

#include "gravure/core/banded.hpp"
#include "gravure/texture/surface.hpp"

namespace gravure::texture {

/// The smoothest path whose points lie within `radius_mm` of those of another: the uniform cubic B-spline with the
/// least integral of the square of its third derivative. Convex; solved by alternating directions (ADMM, over-relaxed)
/// on the banded normal equations of its control points. Knots lie as far apart as the solution bears: some hundred to
/// a wave. Radii may shrink meanwhile; it goes on from where it stood.
class SmoothTube {
 public:
  /// All radii above 0.
  SmoothTube(std::span<const Vector2> path_mm, std::vector<double> radius_mm);
  void narrow(std::size_t point, double radius_mm) { radius_mm_[point] = radius_mm; }
  double radius_mm(std::size_t point) const { return radius_mm_[point]; }
  /// So many steps more.
  void improve(int steps);
  /// The smoothest, apart from the path; out of the tube by what the steps have left over.
  const std::vector<Vector2>& smooth_mm() const noexcept { return smooth_; }
  /// The same drawn into the tube, where it comes to lie in the end.
  const std::vector<Vector2>& bounded_mm() const noexcept { return bounded_; }

 private:
  /// Where point i lies among the control points: the first of its four, and their weights.
  std::size_t first_control(std::size_t point) const { return point / spacing_; }
  const std::array<double, 4>& weights(std::size_t point) const { return weights_[point % spacing_]; }
  void space_knots(std::size_t spacing);
  Banded normal_matrix(double stiffness) const;
  /// Finds the spline for a side as it stands in bounded_ and pull_; into smooth_.
  void fit(const Banded& factored, double stiffness);
  /// The stiffness at which plain smoothing just reaches the wall of the tube somewhere.
  double first_stiffness();
  /// Largest distance from the path by radius.
  double reach() const;
  /// Weighs the two conditions anew where one lags behind the other.
  void balance(double apart_mm, double moved_mm);
  Vector2 inside(std::size_t point, const Vector2& apart_mm) const;

  std::span<const Vector2> path_mm_;
  std::vector<double> radius_mm_;
  std::size_t spacing_ = 1;  ///< points from knot to knot
  std::vector<std::array<double, 4>> weights_;
  std::vector<Vector2> controls_;
  double stiffness_ = 0;
  std::vector<Vector2> smooth_;  ///< apart from the path, as all of these
  std::vector<Vector2> bounded_;
  std::vector<Vector2> pull_;
};

}  // namespace gravure::texture
