#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace gravure {

using Point3 = std::array<double, 3>;  ///< x, y, z

/// Points of a surface: a scan, or samples of a CAD model.
struct PointSet {
  std::vector<Point3> points_mm;
  /// Empty, or one for each point: of length 1 out of the material, or 0 0 0 where it is not known.
  std::vector<Point3> normals;
};

/// A surface of triangles. Seen from outside their vertices run counter-clockwise.
struct TriangleMesh {
  std::vector<Point3> vertices_mm;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into vertices_mm
};

}  // namespace gravure
