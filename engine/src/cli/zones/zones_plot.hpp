#pragma once

#include <string>

#include "gravure/zones/plan_zones.hpp"

namespace gravure::cli {

/// A stand-alone SVG: the contours seen along y and along x, a colour a zone, with the direction of each zone and a
/// table.
std::string zones_to_svg(const zones::ZonePlan& plan, const std::string& title);

}  // namespace gravure::cli
