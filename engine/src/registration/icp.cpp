#include "icp.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace gravure::registration {
namespace {

constexpr double kBesideSpacings = 2;  // further beside its nearest sample a point is beyond the edge
constexpr double kBesideRadii = 0.5;   // while the pose is rough
constexpr double kNormalsAgree = 0.5;  // cosine
constexpr double kMadToDeviation = 1.4826;
constexpr double kInlierDeviations = 4;
constexpr double kLeastRadius = 1e-6;  // of the CAD's radius

/// Median of the distances, by value.
double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double radius_for(const CadSurface& cad, const std::vector<Pair>& pairs, double now) {
  std::vector<double> sizes;
  sizes.reserve(pairs.size());
  for (const Pair& pair : pairs) {
    sizes.push_back(std::abs(pair.distance));
  }
  const double wanted = kInlierDeviations * kMadToDeviation * median(sizes);
  return std::clamp(wanted, kLeastRadius * cad.radius_mm, now);
}

void add_pair(NormalSystem& system, const CadSurface& cad, const Eigen::Vector3d& place, const Pair& pair) {
  if (cad.facing == Facing::none) {  // point on point: three planes
    const Eigen::Vector3d away = place - cad.points[pair.sample];
    for (int axis = 0; axis < 3; ++axis) {
      system.add(place, Eigen::Vector3d::Unit(axis), away[axis]);
    }
    return;
  }
  system.add(cad.points[pair.sample], cad.normals[pair.sample], pair.distance);
}

/// Has the sum stopped falling?
class Stall {
 public:
  bool at(double rms, std::size_t pairs) {
    const double change = std::abs(rms - last_) / std::max(rms, 1e-300);
    quiet_ = change < 1e-5 && pairs + pairs / 1000 >= last_pairs_ && pairs <= last_pairs_ + last_pairs_ / 1000
                 ? quiet_ + 1
                 : 0;
    last_ = rms;
    last_pairs_ = pairs;
    return quiet_ >= 3;
  }

 private:
  double last_ = 0;
  std::size_t last_pairs_ = 0;
  int quiet_ = 0;
};

}  // namespace

bool facing_agrees(const CadSurface& cad, const Eigen::Vector3d& turned, std::size_t sample) {
  const double cosine = turned.dot(cad.normals[sample]);
  const bool unknown = turned.isZero() || cad.facing == Facing::none;
  return unknown || (cad.facing == Facing::oriented ? cosine : std::abs(cosine)) > kNormalsAgree;
}

double largest_beside(const CadSurface& cad, double radius_mm) {
  return std::max(kBesideSpacings * cad.spacing_mm, kBesideRadii * radius_mm);
}

NormalSystem system_for(const CadSurface& cad, const IcpSettings& settings) {
  return settings.length_mm > 0 ? NormalSystem(settings.centre, settings.length_mm)
                                : NormalSystem(cad.centre, cad.radius_mm);
}

bool apply(Similarity& pose, SmallMotion step, double most_scale) {
  const double limit = std::log(most_scale);
  const double now = std::log(pose.scale);
  step.by[6] = (std::clamp(now + step.by[6] / step.length_mm, -limit, limit) - now) * step.length_mm;
  if (!step.by.allFinite()) {
    return false;
  }
  pose = composed(step.similarity(), pose);
  return true;
}

ScanPoints thinned(const ScanPoints& scan, std::size_t step) {
  ScanPoints few;
  for (std::size_t i = 0; i < scan.points.size(); i += step) {
    few.points.push_back(scan.points[i]);
    if (!scan.normals.empty()) {
      few.normals.push_back(scan.normals[i]);
    }
  }
  return few;
}

std::vector<Pair> find_pairs(const CadSurface& cad, const ScanPoints& scan, const Similarity& pose, double radius_mm) {
  std::vector<Pair> pairs;
  pairs.reserve(scan.points.size());
  const double beside = largest_beside(cad, radius_mm);
  const double reach = std::hypot(radius_mm, beside);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3d place = pose.point(scan.points[i]);
    const Neighbour nearest = cad.tree->nearest(place, reach);
    if (nearest.index < 0) {
      continue;
    }
    const auto sample = static_cast<std::size_t>(nearest.index);
    if (!scan.normals.empty() && !facing_agrees(cad, pose.direction(scan.normals[i]), sample)) {
      continue;
    }
    const CadSurface::Offset offset = cad.offset(place, sample);
    const bool by_points = cad.facing == Facing::none;
    const double distance = by_points ? std::sqrt(nearest.distance2) : offset.along_normal;
    if (std::abs(distance) <= radius_mm && (by_points || offset.beside <= beside)) {
      pairs.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(sample), distance});
    }
  }
  return pairs;
}

IcpState icp(const CadSurface& cad, const ScanPoints& scan, const Similarity& start, const IcpSettings& settings) {
  IcpState state;
  state.pose = start;
  state.radius_mm = settings.radius_mm;
  const int unknowns = settings.with_scale ? kAllUnknowns : kRigidUnknowns;
  Stall stall;
  while (state.iterations < settings.most_iterations) {
    const std::vector<Pair> pairs = find_pairs(cad, scan, state.pose, state.radius_mm);
    state.system = system_for(cad, settings);
    if (pairs.size() < kFewestPairs) {
      return state;
    }
    for (const Pair& pair : pairs) {
      add_pair(state.system, cad, state.pose.point(scan.points[pair.point]), pair);
    }
    const SmallMotion step =
        state.system.step(unknowns, settings.weak_share, std::log(state.pose.scale), settings.scale_deviation);
    ++state.iterations;
    if (!apply(state.pose, step, settings.most_scale)) {
      return state;
    }
    const double radius = radius_for(cad, pairs, state.radius_mm);
    const bool shrinks = radius < 0.9 * state.radius_mm;
    state.radius_mm = shrinks ? radius : state.radius_mm;
    if ((step.by.norm() < settings.least_step * cad.radius_mm || stall.at(state.system.rms(), pairs.size())) &&
        !shrinks) {
      state.converged = true;
      return state;
    }
  }
  return state;
}

}  // namespace gravure::registration
