#pragma once

#include <span>

#include "gravure/core/error.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/texture/split.hpp"

namespace gravure::texture {

/// How a workpiece is clamped: turned about x, then about the machine's y, before A and C turn it.
struct Clamping {
  double about_x_rad = 0;
  double about_y_rad = 0;
};

/// A split as it lies in the clamping; deviations are the same.
Split clamped(Split split, const Clamping& clamping);

/// What C does along the stages' path, whatever its signs.
struct CTravel {
  double turns = 0;                ///< of it all, to and fro
  double max_rate_rad_per_mm = 0;  ///< by length of path: a feed of v mm/s needs v times that
  double nearest_pole_rad = 0;     ///< the least tilt of a normal from the C axis
};
CTravel c_travel(std::span<const SurfacePoint> stages, double step_mm, const Clamping& clamping);

struct ClampingAdvice {
  Clamping clamping;
  CTravel flat;       ///< as it lies now
  CTravel tilted;     ///< in the clamping
  bool pays = false;  ///< C turns slower by a fifth or more
};

/// The least tilt, up to `most_tilt_rad`, whose fastest turn of C is within a fifth of the slowest that any has: by
/// trial of tilts a degree apart in 24 directions, on some thousand points, figures then of all of them. cancelled on
/// request.
Result<ClampingAdvice> advise_clamping(std::span<const SurfacePoint> stages, double step_mm, double most_tilt_rad,
                                       const CancelToken& cancel);

}  // namespace gravure::texture
