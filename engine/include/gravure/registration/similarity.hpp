#pragma once

#include <Eigen/Core>
#include <span>

#include "gravure/core/error.hpp"
#include "gravure/core/point_set.hpp"

namespace gravure::registration {

/// Turns, then stretches, then shifts: p -> scale * rotation * p + translation.
struct Similarity {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();
  double scale = 1;

  Eigen::Vector3d point(const Eigen::Vector3d& place_mm) const {
    return scale * (rotation * place_mm) + translation_mm;
  }
  /// A direction stays of its length: it is turned, not stretched.
  Eigen::Vector3d direction(const Eigen::Vector3d& along) const { return rotation * along; }
  Point3 point(const Point3& place_mm) const;
  Point3 direction(const Point3& along) const;
  Similarity inverse() const;
  /// 4x4, for columns x y z 1.
  Eigen::Matrix4d matrix() const;
};

/// First `first`, then `second`.
Similarity composed(const Similarity& second, const Similarity& first);

/// The similarity that brings `from` nearest to `to`, point i on point i, in the sense of least squares, in closed
/// form; without scale it is 1. Never a reflection. [D] with Umeyama's determinant sign. bad_argument unless both have
/// the same number of points, 3 or more, and `from` is not on one line.
Result<Similarity> similarity_of_pairs(std::span<const Point3> from, std::span<const Point3> to, bool with_scale);

}  // namespace gravure::registration
