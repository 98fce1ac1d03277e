#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/point_set.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/registration/similarity.hpp"

namespace gravure::registration {

inline constexpr std::size_t kMostPoints = 20'000'000;  ///< of CAD or scan
inline constexpr std::size_t kFewestPoints = 30;

/// A CAD model as samples of its surface, or as triangles, where `triangles` is not empty.
struct CadModel {
  PointSet samples;
  TriangleMesh mesh;
};

inline constexpr int kRegistrationSteps = 4;  ///< that progress is told of

struct RegistrationOptions {
  bool with_scale = false;   ///< the scan may be larger or smaller than the CAD: tried after the rigid pose is found
  Similarity start;          ///< CAD to scan, roughly; tried beside the principal axes
  double most_scale = 1.25;  ///< scale stays within 1/this .. this
  double scale_deviation = 0.05;  ///< how far from 1 scale is expected to be; counts only where the points say little
  /// A direction is weak where the normal matrix says less than this share of what it says in the best one.
  double weak_share = 1e-4;
  int most_iterations = 200;
  Progress* progress =
      nullptr;  ///< told after each of kRegistrationSteps: surface, start, pose of a few points, of all
};

/// A motion of the CAD that the points do not hold: along or about it the pose is that of the start.
struct WeakDirection {
  std::string name;  ///< "turn about (0, 0, 1) through (1, 2, 3)", "shift along (1, 0, 0)", "scale"; CAD frame, mm
  double eigenvalue = 0;
};

struct Registration {
  Similarity cad_to_scan;
  double rms_mm = 0;             ///< of the inliers' distances from the surface, in the scale of the CAD
  std::int64_t inliers = 0;      ///< scan points that lie on the surface, within 4 standard deviations
  std::int64_t scan_points = 0;  ///< of which `inliers` were
  int iterations = 0;
  bool converged = false;
  bool degenerate = false;  ///< some direction is weak
  /// Weak directions are as the start has them; false where the scan would then no longer lie on the CAD.
  bool kept_as_started = true;
  bool scale_refused = false;  ///< scale was asked for but is not observable: it is 1
  bool ambiguous = false;      ///< another pose fits nearly as well: a part of some symmetry
  std::string shape;           ///< "plane", "cylinder", "sphere" ...; empty where no direction is weak
  /// Of the normal matrix of the unknowns (turn times rms radius, shift, logarithm of scale times rms radius), per
  /// point, smallest first; 6, or 7 with scale.
  std::vector<double> eigenvalues;
  std::vector<double> deviations_mm;  ///< standard deviation of the unknowns along each eigenvector
  double condition_number = 0;        ///< largest eigenvalue through smallest; 1e300 where that is 0
  std::vector<WeakDirection> weak_directions;
  /// For each scan point its distance from the surface, outside positive, mm in the CAD's scale; NaN where it lies on
  /// no part of the surface.
  std::vector<double> residuals_mm;
};

/// Lays the CAD model on the scan: starts from `options.start` and from the principal axes, point-to-plane where there
/// are normals (estimated from neighbours where the CAD has none; point-to-point where neighbours make no surface),
/// rigid first, then with scale. Deterministic, one thread.
///
/// Fails with bad_argument: fewer than 30 or more than 20 million points, normals of another number, points on one
/// place or line, options out of range; out_of_range where nothing of the scan comes near the CAD from any start.
Result<Registration> register_scan(const CadModel& cad, const PointSet& scan, const RegistrationOptions& options);

/// `count` or a few more points on the triangles, spread by area, with the triangles' normals. Always the same ones.
PointSet sample_mesh(const TriangleMesh& mesh, std::size_t count);

}  // namespace gravure::registration
