#pragma once

#include <vector>

#include "icp.hpp"

namespace gravure::registration {

/// Takes the planes of all points from several samples each, so that those of a curved surface are no longer tangents
/// beside the point, and solves against these planes until nothing moves. `residuals`, where given, gets each point's
/// distance, NaN without a pair.
IcpState polish(const CadSurface& cad, const ScanPoints& scan, const IcpState& start, const IcpSettings& settings,
                std::vector<double>* residuals);

}  // namespace gravure::registration
