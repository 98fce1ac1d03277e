#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "blade_surface.hpp"
#include "gravure/registration/register_scan.hpp"

#define GRAVURE_TRACE_DICE() SCOPED_TRACE(gravure::test::Dice::note())

namespace gravure::registration::test {

using gravure::test::BladeSurface;
using gravure::test::Dice;

inline Eigen::Vector3d vec(const Point3& p) {
  return {p[0], p[1], p[2]};
}

inline Similarity pose(double angle_rad, const Eigen::Vector3d& axis, const Eigen::Vector3d& shift, double scale = 1) {
  Similarity made;
  made.rotation = Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix();
  made.translation_mm = shift;
  made.scale = scale;
  return made;
}

/// The set moved, each coordinate with noise on top.
inline PointSet moved(const PointSet& set, const Similarity& by, double noise_mm, Dice& dice) {
  PointSet there;
  for (std::size_t i = 0; i < set.points_mm.size(); ++i) {
    Point3 point = by.point(set.points_mm[i]);
    for (double& value : point) {
      value += noise_mm * BladeSurface::normal(dice);
    }
    there.points_mm.push_back(point);
    if (!set.normals.empty()) {
      there.normals.push_back(by.direction(set.normals[i]));
    }
  }
  return there;
}

/// Root mean square distance between where two poses put the points.
inline double rms_between(const Similarity& a, const Similarity& b, const std::vector<Point3>& points) {
  double sum = 0;
  for (const Point3& point : points) {
    sum += (vec(a.point(point)) - vec(b.point(point))).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

inline PointSet without_normals(PointSet set) {
  set.normals.clear();
  return set;
}

}  // namespace gravure::registration::test
