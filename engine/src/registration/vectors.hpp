#pragma once

#include <Eigen/Core>
#include <vector>

#include "gravure/core/point_set.hpp"

namespace gravure::registration {

using Vectors = std::vector<Eigen::Vector3d>;

inline Eigen::Vector3d vector(const Point3& point) {
  return {point[0], point[1], point[2]};
}

inline Point3 point3(const Eigen::Vector3d& vector) {
  return {vector[0], vector[1], vector[2]};
}

inline Vectors vectors(const std::vector<Point3>& points) {
  Vectors all;
  all.reserve(points.size());
  for (const Point3& point : points) {
    all.push_back(vector(point));
  }
  return all;
}

}  // namespace gravure::registration
