#include "bend_contour.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>

namespace gravure::registration {
namespace {

struct Around {
  double mean = 0;
  double weight = 0;
};

/// Mean distance of the scan points within `radius` of the place, on its side of the part.
Around distances_around(const KdTree& tree, const CadSurface& cad, const std::vector<std::size_t>& samples,
                        const std::vector<double>& residuals, const Eigen::Vector3d& place,
                        const Eigen::Vector3d& normal, double radius) {
  constexpr double kSameSide = 0.7;
  std::vector<std::size_t> near;
  tree.within(place, radius, near);
  std::sort(near.begin(), near.end());
  Around around;
  for (const std::size_t i : near) {
    if (std::isfinite(residuals[i]) && normal.dot(cad.normals[samples[i]]) > kSameSide) {
      around.mean += residuals[i];
      around.weight += 1;
    }
  }
  around.mean /= std::max(1.0, around.weight);
  return around;
}

/// The values that leave least of weight * (value - mean)^2 + the squares of second differences.
Eigen::VectorXd smoothed(const Vectors& contour, const std::vector<Around>& around, double bend_mm) {
  const auto count = static_cast<Eigen::Index>(contour.size());
  double all = 0;
  for (const Around& one : around) {
    all += one.weight;
  }
  const double typical = std::max(1.0, all / static_cast<double>(count));
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Around& one = around[static_cast<std::size_t>(i)];
    entries.emplace_back(i, i, one.weight + 1e-9 * typical);
    right[i] = one.weight * one.mean;
  }
  for (Eigen::Index i = 1; i + 1 < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double before = std::max(1e-6, (contour[k] - contour[k - 1]).norm());
    const double after = std::max(1e-6, (contour[k + 1] - contour[k]).norm());
    const double step = (before + after) / 2;
    // Second derivative times bend_mm^2: bending over a length of bend_mm costs what a misfit of its size does.
    const double size = bend_mm * bend_mm / step;
    const double row[3] = {size / before, -size / before - size / after, size / after};
    for (Eigen::Index a = 0; a < 3; ++a) {
      for (Eigen::Index b = 0; b < 3; ++b) {
        entries.emplace_back(i - 1 + a, i - 1 + b, typical * row[a] * row[b]);
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::VectorXd values = solver.solve(right);
  return solver.info() == Eigen::Success && values.allFinite() ? values : Eigen::VectorXd::Zero(count);
}

}  // namespace

Vectors bend_contour(const CadSurface& cad, const ScanPoints& crop, const Similarity& pose,
                     const std::vector<double>& residuals, const Vectors& contour, const ContourOptions& options) {
  Vectors placed;
  std::vector<std::size_t> samples;
  for (const Eigen::Vector3d& point : crop.points) {
    placed.push_back(pose.point(point));
    samples.push_back(
        static_cast<std::size_t>(cad.tree->nearest(placed.back(), std::numeric_limits<double>::max()).index));
  }
  const KdTree tree(placed);
  std::vector<Around> around;
  Vectors normals;
  for (const Eigen::Vector3d& point : contour) {
    normals.push_back(
        cad.normals[static_cast<std::size_t>(cad.tree->nearest(point, std::numeric_limits<double>::max()).index)]);
    around.push_back(distances_around(tree, cad, samples, residuals, point, normals.back(),
                                      std::min(options.crop_mm, options.bend_mm) / 2));
  }
  const Eigen::VectorXd shifts = smoothed(contour, around, options.bend_mm);
  Vectors bends;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    bends.emplace_back(shifts[static_cast<Eigen::Index>(i)] * normals[i]);
  }
  return bends;
}

}  // namespace gravure::registration
