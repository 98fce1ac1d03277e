#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gravure/registration/register_scan.hpp"
#include "vectors.hpp"

namespace gravure::registration {
namespace {

// Additive recurrence with the plastic number: points that fill a square evenly whatever their count.
constexpr double kStepU = 0.7548776662466927;
constexpr double kStepV = 0.5698402909980532;

struct Corners {
  Eigen::Vector3d a, b, c;
};

Corners corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto [a, b, c] = mesh.triangles[triangle];
  return {vector(mesh.vertices_mm[a]), vector(mesh.vertices_mm[b]), vector(mesh.vertices_mm[c])};
}

Eigen::Vector3d area_vector(const Corners& at) {
  return (at.b - at.a).cross(at.c - at.a) / 2;
}

}  // namespace

PointSet sample_mesh(const TriangleMesh& mesh, std::size_t count) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    area += area_vector(corners_of(mesh, t)).norm();
  }
  PointSet samples;
  const double share = area / static_cast<double>(count);
  if (!(share > 0)) {
    return samples;
  }
  double due = share / 2;  // area until the next sample
  double u = 0.5;
  double v = 0.5;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners at = corners_of(mesh, t);
    const Eigen::Vector3d normal = area_vector(at);
    const double size = normal.norm();
    due -= size;
    while (due < 0 && size > 0) {
      u = std::fmod(u + kStepU, 1.0);
      v = std::fmod(v + kStepV, 1.0);
      const bool beyond = u + v > 1;  // in the other half of the parallelogram: folded back
      const double along_b = beyond ? 1 - u : u;
      const double along_c = beyond ? 1 - v : v;
      samples.points_mm.push_back(point3(at.a + along_b * (at.b - at.a) + along_c * (at.c - at.a)));
      samples.normals.push_back(point3(normal / size));
      due += share;
    }
  }
  return samples;
}

}  // namespace gravure::registration
