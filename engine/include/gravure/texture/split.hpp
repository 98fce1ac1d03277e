#pragma once

#include <optional>
#include <vector>

#include "gravure/core/progress.hpp"
#include "gravure/texture/decomposition.hpp"

namespace gravure::texture {

/// What the galvo may be asked for at any point of the path; [A]: 0.1 mm, 10 degrees, 5 mm.
struct DeviationLimits {
  double focus_mm = 0.1;
  double incidence_rad = 0.17453292519943295;
  double displacement_mm = 5;
};

/// A path on a surface and what the stages follow of it, point by point.
struct Split {
  double sigma_mm = 0;
  std::vector<SurfacePoint> targets;
  std::vector<SurfacePoint> stages;
  DeviationSummary most;
  int tries = 1;  ///< sigmas that were looked at
};

/// A path in the plane whose points lie `step_mm` of arc length apart, on a surface.
struct TexturePath {
  std::vector<Vector2> points_mm;
  double step_mm = 0;
  /// Length by which pulses are placed, at each point, the same at both ends of a dark step; never falls. Empty: the
  /// length of the path on the surface, but for steps that are dark.
  std::vector<double> pulse_mm = {};
  /// True where the step to a point is dark; empty: no step is.
  std::vector<bool> dark = {};
};

/// TexturePath::pulse_mm, or what stands for it where it is empty; `targets` are the points on the surface.
std::vector<double> pulse_lengths_mm(const TexturePath& path, std::span<const SurfacePoint> targets);

/// Splits by one sigma (filter.sigma_mm). Errors as slow_part() and Surface::project().
Result<Split> split_path(const Surface& surface, const TexturePath& path, const GaussianFilter& filter);

/// Splits by the first sigma of 30, 30 * 0.95, 30 * 0.95^2 ... mm that meets the limits at every point: the rule of
/// [A]. filter.sigma_mm is not looked at. out_of_range, with the best that was found, where none above the path's step
/// does; cancelled on request, looked at between sigmas.
Result<Split> split_by_published_rule(const Surface& surface, const TexturePath& path, const DeviationLimits& limits,
                                      GaussianFilter filter, const CancelToken& cancel);

/// What of the limits is broken, largest first in words with value and limit; empty: nothing.
std::vector<std::string> violations(const DeviationSummary& most, const DeviationLimits& limits);

}  // namespace gravure::texture
