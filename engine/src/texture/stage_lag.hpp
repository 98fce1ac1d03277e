#pragma once

#include "gravure/texture/path_timing.hpp"
#include "path_spline.hpp"
#include "smooth_place.hpp"

namespace gravure::texture {

/// TimedPath::stage_lag_mm.
double stage_lag_mm(const PathTimingRequest& request, const StageSpline& stages, const SmoothPlace& place);

}  // namespace gravure::texture
