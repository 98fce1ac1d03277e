#include "cad_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <tuple>

#include "estimate_normals.hpp"

namespace gravure::registration {
namespace {

constexpr std::size_t kMeshSamples = 200'000;
constexpr double kRoughest = 0.1;  // more of the neighbours' spread out of their plane is no surface

/// From the 4th neighbours of some samples: the 95th percentile of the side of the square that a sample stands for.
double spacing_of(const Vectors& points, const KdTree& tree) {
  constexpr std::size_t kAsked = 500;
  constexpr std::size_t kFourth = 4;
  std::vector<double> sides;
  std::vector<Neighbour> near;
  for (std::size_t i = 0; i < kAsked; ++i) {
    const std::size_t sample = points.size() * i / kAsked;
    tree.nearest(points[sample], std::numeric_limits<double>::max(), kFourth + 1, near);
    sides.push_back(std::sqrt(near.back().distance2 * std::numbers::pi / kFourth));
  }
  std::sort(sides.begin(), sides.end());
  return sides[sides.size() * 95 / 100];
}

Result<void> check_samples(const PointSet& samples) {
  if (samples.points_mm.size() < kFewestPoints || samples.points_mm.size() > kMostPoints) {
    return Error{ErrorCode::bad_argument,
                 "CAD: " + std::to_string(samples.points_mm.size()) + " points: must be 30 to 20 million"};
  }
  if (!samples.normals.empty() && samples.normals.size() != samples.points_mm.size()) {
    return Error{ErrorCode::bad_argument, "CAD: " + std::to_string(samples.normals.size()) + " normals for " +
                                              std::to_string(samples.points_mm.size()) +
                                              " points: must be none or as many"};
  }
  for (std::size_t i = 0; i < samples.points_mm.size(); ++i) {
    if (!vector(samples.points_mm[i]).allFinite() ||
        (!samples.normals.empty() && !vector(samples.normals[i]).allFinite())) {
      return Error{ErrorCode::bad_argument, "CAD: point " + std::to_string(i) + " is not finite: leave it out"};
    }
  }
  return {};
}

/// Samples without a normal say nothing about their plane: out, unless none has one.
PointSet with_normals_only(PointSet samples) {
  const auto known = [](const Point3& normal) { return normal[0] != 0 || normal[1] != 0 || normal[2] != 0; };
  std::size_t kept = 0;
  for (std::size_t i = 0; i < samples.normals.size(); ++i) {
    if (known(samples.normals[i])) {
      samples.points_mm[kept] = samples.points_mm[i];
      samples.normals[kept++] = samples.normals[i];
    }
  }
  samples.normals.resize(kept);
  if (kept > 0) {
    samples.points_mm.resize(kept);
  }
  return samples;
}

}  // namespace

std::pair<Eigen::Vector3d, double> centre_and_radius(const Vectors& points) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    centre += point;
  }
  centre /= static_cast<double>(points.size());
  double square = 0;
  for (const Eigen::Vector3d& point : points) {
    square += (point - centre).squaredNorm();
  }
  return {centre, std::sqrt(square / static_cast<double>(points.size()))};
}

CadSurface::Offset CadSurface::offset(const Eigen::Vector3d& place, std::size_t sample) const {
  const Eigen::Vector3d away = place - points[sample];
  const double along = normals[sample].dot(away);
  return {along, std::sqrt(std::max(0.0, away.squaredNorm() - along * along))};
}

Result<CadSurface> make_cad_surface(const CadModel& cad) {
  CadSurface surface;
  surface.flat_facets = !cad.mesh.triangles.empty();
  if (!surface.flat_facets) {
    GRAVURE_CHECK(check_samples(cad.samples));
  }
  const PointSet samples = surface.flat_facets
                               ? sample_mesh(cad.mesh, std::max(kMeshSamples, cad.mesh.triangles.size()))
                               : with_normals_only(cad.samples);
  GRAVURE_CHECK(check_samples(samples));
  surface.points = vectors(samples.points_mm);
  std::tie(surface.centre, surface.radius_mm) = centre_and_radius(surface.points);
  if (!(surface.radius_mm > 0) || !std::isfinite(surface.radius_mm)) {
    return Error{ErrorCode::bad_argument, "CAD: all points are at one place, or not finite: nothing to lay a scan on"};
  }
  surface.tree = std::make_unique<KdTree>(surface.points);
  surface.spacing_mm = spacing_of(surface.points, *surface.tree);
  surface.normals = vectors(samples.normals);
  if (surface.normals.empty()) {
    EstimatedNormals estimated = estimate_normals(surface.points, *surface.tree);
    surface.facing = estimated.roughness < kRoughest ? Facing::unoriented : Facing::none;
    surface.normals = std::move(estimated.normals);
  }
  return surface;
}

}  // namespace gravure::registration
