#include "estimate_normals.hpp"

#include <Eigen/Eigenvalues>
#include <limits>

namespace gravure::registration {
namespace {

constexpr std::size_t kNeighbours = 12;

}  // namespace

EstimatedNormals estimate_normals(const Vectors& points, const KdTree& tree) {
  EstimatedNormals all;
  all.normals.reserve(points.size());
  std::vector<Neighbour> near;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  for (const Eigen::Vector3d& point : points) {
    tree.nearest(point, std::numeric_limits<double>::max(), kNeighbours, near);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Neighbour& neighbour : near) {
      mean += points[static_cast<std::size_t>(neighbour.index)];
    }
    mean /= static_cast<double>(near.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Neighbour& neighbour : near) {
      const Eigen::Vector3d away = points[static_cast<std::size_t>(neighbour.index)] - mean;
      spread += away * away.transpose();
    }
    solver.compute(spread);
    const Eigen::Vector3d size = solver.eigenvalues();
    const bool surface = size[1] > 1e-6 * size[2];
    all.normals.push_back(surface ? Eigen::Vector3d(solver.eigenvectors().col(0)) : Eigen::Vector3d::Zero());
    all.roughness += (surface ? size[0] / size.sum() : 1.0 / 3) / static_cast<double>(points.size());
  }
  return all;
}

}  // namespace gravure::registration
