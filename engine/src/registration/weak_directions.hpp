#pragma once

#include "gravure/registration/register_scan.hpp"
#include "normal_system.hpp"

namespace gravure::registration {

/// Fills in eigenvalues, deviations, condition number, weak directions and shape from the system at the end.
void describe_weak_directions(const NormalSystem& system, int unknowns, const Eigen::Vector3d& centre, double length_mm,
                              double weak_share, Registration& result);

}  // namespace gravure::registration
