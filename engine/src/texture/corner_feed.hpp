#pragma once

#include <vector>

#include "gravure/texture/path_timing.hpp"

namespace gravure::texture {

/// How fast the stages may pass each point, points a second, by the law of corners (corner_law.hpp): round corners of
/// the plane that are straight for three sigma to both sides, rising from them as the bend of a Gaussian falls.
/// Infinite everywhere else; empty where there is no such corner.
std::vector<double> corner_feed(const PathTimingRequest& request);

}  // namespace gravure::texture
