#pragma once

#include "icp.hpp"

namespace gravure::registration {

/// `pose` moved in the directions that `system` does not hold, and in no other, until it differs from `start` as little
/// as it can: turns of a sphere about its centre, shifts in a plane. Both scan to CAD.
Similarity with_start_kept(const NormalSystem& system, double weak_share, const CadSurface& cad, const Similarity& pose,
                           const Similarity& start);

/// Lays `state`, found by polish(), back to `start` where it is not held, and lets the rest settle again. False, and
/// nothing changed, where the scan would then not lie on the CAD as well as it does: a long way along an axis may lead
/// off its end.
bool keep_start(const CadSurface& cad, const ScanPoints& scan, const Similarity& start, const IcpSettings& settings,
                IcpState& state, std::vector<double>& residuals);

}  // namespace gravure::registration
