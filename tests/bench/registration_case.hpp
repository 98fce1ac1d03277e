#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "blade_surface.hpp"
#include "gravure/registration/register_scan.hpp"

namespace gravure::bench {

using registration::Similarity;
using test::BladeSurface;
using test::Dice;

/// 10 um of noise; half a millimetre and 0.6 degrees away.
inline Similarity true_pose(double scale) {
  Similarity pose;
  pose.rotation = Eigen::AngleAxisd(0.0105, Eigen::Vector3d(1, 2, -1.5).normalized()).toRotationMatrix();
  pose.translation_mm = {0.3, -0.35, 0.2};
  pose.scale = scale;
  return pose;
}

inline PointSet scan_of(std::size_t count, double scale, Dice& dice) {
  const Similarity pose = true_pose(scale);
  PointSet scan;
  for (const Point3& point : BladeSurface::points(count, dice).points_mm) {
    Point3 there = pose.point(point);
    for (double& value : there) {
      value += 0.01 * BladeSurface::normal(dice);
    }
    scan.points_mm.push_back(there);
  }
  return scan;
}

/// Root mean square distance between where two poses put the CAD.
inline double pose_error_um(const PointSet& cad, const Similarity& one, const Similarity& other) {
  double sum = 0;
  for (const Point3& point : cad.points_mm) {
    const Point3 a = one.point(point);
    const Point3 b = other.point(point);
    sum += std::pow(a[0] - b[0], 2) + std::pow(a[1] - b[1], 2) + std::pow(a[2] - b[2], 2);
  }
  return 1e3 * std::sqrt(sum / static_cast<double>(cad.points_mm.size()));
}

}  // namespace gravure::bench
