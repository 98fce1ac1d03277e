#include "polish.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gravure::registration {
namespace {

/// The plane half way between that at the sample and that at the point, so that a chord of a circle lies in it.
class LocalPlane {
 public:
  explicit LocalPlane(const CadSurface& cad) : cad_(cad) {}

  /// The sample's own, with `resolved` false, where the samples do not resolve the surface: on an edge.
  Eigen::Vector3d normal_at(const Eigen::Vector3d& place, const std::vector<Neighbour>& near, bool& resolved) const {
    const Eigen::Vector3d normal = cad_.normals[static_cast<std::size_t>(near.front().index)];
    resolved = true;
    if (cad_.flat_facets || cad_.facing == Facing::none) {
      return normal;
    }
    const Eigen::Vector3d there = interpolated(place, near, normal);
    const double length = there.norm();
    resolved = length > 0.9 && length < 1.1;
    return resolved ? Eigen::Vector3d((normal + there / length).normalized()) : normal;
  }

 private:
  /// Normal at the foot of `place`: that of the samples, weighted by the smallest weights that reproduce what is
  /// linear.
  Eigen::Vector3d interpolated(const Eigen::Vector3d& place, const std::vector<Neighbour>& near,
                               const Eigen::Vector3d& normal) const {
    const auto centre = static_cast<std::size_t>(near.front().index);
    const Eigen::Vector3d first = normal.unitOrthogonal();
    const Eigen::Vector3d second = normal.cross(first);
    constexpr std::size_t kMost = 8;
    std::array<Eigen::Vector3d, kMost> row;
    std::array<Eigen::Vector3d, kMost> value;
    std::size_t used = 0;
    Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < near.size() && used < kMost; ++i) {
      const auto sample = static_cast<std::size_t>(near[i].index);
      const double cosine = normal.dot(cad_.normals[sample]);
      if (std::abs(cosine) < kSameSheet || (cosine < 0 && cad_.facing == Facing::oriented)) {
        continue;  // the other side of a thin blade, or beyond an edge
      }
      const Eigen::Vector3d away = (cad_.points[sample] - cad_.points[centre]) / cad_.spacing_mm;
      row[used] = {1, first.dot(away), second.dot(away)};
      value[used] = cosine < 0 ? Eigen::Vector3d(-cad_.normals[sample]) : cad_.normals[sample];
      gram += row[used] * row[used].transpose();
      ++used;
    }
    const Eigen::Vector3d away = (place - cad_.points[centre]) / cad_.spacing_mm;
    bool solved = false;
    Eigen::Matrix3d inverse;
    gram.computeInverseWithCheck(inverse, solved, 1e-3);
    if (used < 4 || !solved) {
      return Eigen::Vector3d::Zero();
    }
    const Eigen::Vector3d weigh = inverse * Eigen::Vector3d(1, first.dot(away), second.dot(away));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < used; ++i) {
      sum += row[i].dot(weigh) * value[i];
    }
    return sum;
  }

  static constexpr double kSameSheet = 0.9;
  const CadSurface& cad_;
};

struct Plane {
  std::uint32_t point = 0;
  Eigen::Vector3d at;
  Eigen::Vector3d normal;
  bool resolved = true;
};

std::vector<Plane> find_planes(const CadSurface& cad, const ScanPoints& scan, const IcpState& state) {
  constexpr std::size_t kPlanePoints = 6;
  const LocalPlane local(cad);
  const double beside = largest_beside(cad, state.radius_mm);
  const double reach = std::hypot(state.radius_mm, beside);
  std::vector<Plane> planes;
  planes.reserve(scan.points.size());
  std::vector<Neighbour> near;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3d place = state.pose.point(scan.points[i]);
    if (cad.flat_facets || cad.facing == Facing::none) {
      near.assign(1, cad.tree->nearest(place, reach));
    } else {
      cad.tree->nearest(place, reach, kPlanePoints, near);
    }
    if (near.empty() || near.front().index < 0) {
      continue;
    }
    const auto sample = static_cast<std::size_t>(near.front().index);
    if (!scan.normals.empty() && !facing_agrees(cad, state.pose.direction(scan.normals[i]), sample)) {
      continue;
    }
    const CadSurface::Offset offset = cad.offset(place, sample);
    bool resolved = true;
    const Eigen::Vector3d normal = local.normal_at(place, near, resolved);
    const double distance =
        cad.facing == Facing::none ? std::sqrt(near.front().distance2) : normal.dot(place - cad.points[sample]);
    if (std::abs(distance) <= state.radius_mm && (cad.facing == Facing::none || offset.beside <= beside)) {
      planes.push_back({static_cast<std::uint32_t>(i), cad.points[sample], normal, resolved});
    }
  }
  return planes;
}

void add_plane(NormalSystem& system, const CadSurface& cad, const Eigen::Vector3d& place, const Plane& plane) {
  const Eigen::Vector3d away = place - plane.at;
  if (cad.facing != Facing::none) {
    system.add(place - away / 2, plane.normal, plane.normal.dot(away));
    return;
  }
  for (int axis = 0; axis < 3; ++axis) {
    system.add(place, Eigen::Vector3d::Unit(axis), away[axis]);
  }
}

/// Against the planes of places where the surface is resolved, while they are the more; false where a step is not
/// finite.
bool solve_planes(const CadSurface& cad, const ScanPoints& scan, const std::vector<Plane>& planes,
                  const IcpSettings& settings, IcpState& state) {
  constexpr int kMostSteps = 10;
  const int unknowns = settings.with_scale ? kAllUnknowns : kRigidUnknowns;
  const auto good = std::count_if(planes.begin(), planes.end(), [](const Plane& plane) { return plane.resolved; });
  const bool all = 2 * good < static_cast<std::ptrdiff_t>(planes.size());
  for (int i = 0; i < kMostSteps; ++i) {
    state.system = system_for(cad, settings);
    for (const Plane& plane : planes) {
      if (all || plane.resolved) {
        add_plane(state.system, cad, state.pose.point(scan.points[plane.point]), plane);
      }
    }
    const SmallMotion step =
        state.system.step(unknowns, settings.weak_share, std::log(state.pose.scale), settings.scale_deviation);
    ++state.iterations;
    if (!apply(state.pose, step, settings.most_scale)) {
      return false;
    }
    if (step.by.norm() < settings.least_step * cad.radius_mm) {
      return true;
    }
  }
  return true;
}

void store_residuals(const CadSurface& cad, const ScanPoints& scan, const std::vector<Plane>& planes,
                     const Similarity& pose, std::vector<double>& residuals) {
  residuals.assign(scan.points.size(), std::numeric_limits<double>::quiet_NaN());
  for (const Plane& plane : planes) {
    const Eigen::Vector3d away = pose.point(scan.points[plane.point]) - plane.at;
    residuals[plane.point] = cad.facing == Facing::none ? away.norm() : plane.normal.dot(away);
  }
}

}  // namespace

IcpState polish(const CadSurface& cad, const ScanPoints& scan, const IcpState& start, const IcpSettings& settings,
                std::vector<double>* residuals) {
  constexpr int kMostRounds = 4;
  IcpState state = start;
  state.converged = false;
  for (int round = 0; round < kMostRounds; ++round) {
    const Similarity before = state.pose;
    const Eigen::Vector3d middle = before.inverse().point(cad.centre);
    const std::vector<Plane> planes = find_planes(cad, scan, state);
    if (planes.size() < kFewestPairs || !solve_planes(cad, scan, planes, settings, state)) {
      return state;
    }
    if (residuals != nullptr) {
      store_residuals(cad, scan, planes, state.pose, *residuals);
    }
    // Nearest samples stay the nearest while points move by little of the spacing.
    const double moved = (state.pose.rotation - before.rotation).norm() * cad.radius_mm +
                         std::abs(state.pose.scale - before.scale) * cad.radius_mm +
                         (state.pose.point(middle) - cad.centre).norm();
    if (moved < std::max(0.05 * cad.spacing_mm, 1e-6 * cad.radius_mm)) {
      state.converged = start.converged;
      return state;
    }
  }
  return state;
}

}  // namespace gravure::registration
