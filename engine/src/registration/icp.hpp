#pragma once

#include <cstdint>
#include <vector>

#include "cad_surface.hpp"
#include "normal_system.hpp"

namespace gravure::registration {

/// Scan points that follow each other in space, with normals or none.
struct ScanPoints {
  Vectors points;
  Vectors normals;
};

/// Every `step`-th.
ScanPoints thinned(const ScanPoints& scan, std::size_t step);

struct IcpSettings {
  double radius_mm = 0;  ///< first radius of search; it shrinks with the distances
  bool with_scale = false;
  double weak_share = 1e-4;
  double most_scale = 1.25;
  double scale_deviation = 0.05;
  /// Of turns and scale; length 0: those of the CAD.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double length_mm = 0;
  int most_iterations = 100;
  /// Stops when a step moves the points by less than this share of the CAD's radius.
  double least_step = 1e-7;
};

struct IcpState {
  Similarity pose;  ///< scan to CAD
  double radius_mm = 0;
  int iterations = 0;
  bool converged = false;
  NormalSystem system{Eigen::Vector3d::Zero(), 1};  ///< of the last pairs
};

/// A scan point brought into the frame of the CAD, and the plane it is held against.
struct Pair {
  std::uint32_t point = 0;
  std::uint32_t sample = 0;
  double distance = 0;
};

/// Pairs of nearest points within the radius whose scan point lies above its sample, not beside the surface's edge, and
/// whose normals agree.
std::vector<Pair> find_pairs(const CadSurface& cad, const ScanPoints& scan, const Similarity& pose, double radius_mm);

/// Iterates from `start`. A step that is not finite, or fewer than 12 pairs, ends it unconverged.
IcpState icp(const CadSurface& cad, const ScanPoints& scan, const Similarity& start, const IcpSettings& settings);

// What icp() and polish() share.
inline constexpr std::size_t kFewestPairs = 12;
/// May a scan normal, turned into the frame of the CAD, belong to this sample?
bool facing_agrees(const CadSurface& cad, const Eigen::Vector3d& turned, std::size_t sample);
/// How far beside its nearest sample a point may lie: further, it is beyond the edge of the surface.
double largest_beside(const CadSurface& cad, double radius_mm);
/// Empty, about the centre that the settings name.
NormalSystem system_for(const CadSurface& cad, const IcpSettings& settings);
/// Moves the pose by a step, scale kept within its limits; false when the step is not finite.
bool apply(Similarity& pose, SmallMotion step, double most_scale);

}  // namespace gravure::registration
