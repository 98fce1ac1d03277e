#pragma once

#include <span>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/texture/surface.hpp"

namespace gravure::texture {

/// How a path goes on beyond its ends for the filter.
enum class Ends : std::uint8_t {
  odd,     ///< mirrored through the end points: straight ends stay where they are
  repeat,  ///< the end points for ever, as in [A]
};

struct GaussianFilter {
  double sigma_mm = 0;  ///< of arc length
  double cut = 8;       ///< the kernel ends at so many sigma; [A] has 4
  Ends ends = Ends::odd;
};

/// The slow part of a path whose points lie `step_mm` of arc length apart: each coordinate weighted by
/// exp(-s^2 / (2 sigma^2)) round the point, weights normalised over int(cut sigma / step + 0.5) steps to both sides
/// ([A] section 1.1), by FFT. Stages follow the slow part, the galvo what is left. out_of_range for sigma, step or cut
/// that are not above 0.
Result<std::vector<Vector2>> slow_part(std::span<const Vector2> path_mm, double step_mm, const GaussianFilter& filter);

/// Where a point of the surface lies for a head whose spot stands on another, along its normal: [A] figure 3, 1.2.
struct Deviation {
  double focus_mm = 0;         ///< FOD, signed: along the stage point's normal
  double incidence_rad = 0;    ///< BIA: between the two normals
  double displacement_mm = 0;  ///< across that normal: what the galvo must reach
};
Deviation deviation(const SurfacePoint& target, const SurfacePoint& stage);

/// The largest of each (focus: of its magnitude) and where.
struct DeviationSummary {
  double max_focus_mm = 0;
  double rms_focus_mm = 0;
  double max_incidence_rad = 0;
  double max_displacement_mm = 0;
};
DeviationSummary summarise(std::span<const SurfacePoint> targets, std::span<const SurfacePoint> stages);

}  // namespace gravure::texture
