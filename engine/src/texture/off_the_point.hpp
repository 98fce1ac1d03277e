#pragma once

#include <array>

#include "gravure/core/path_motion.hpp"
#include "gravure/texture/axis_limits.hpp"

namespace gravure::texture {

/// Where the light is off its point of the surface, in the head's coordinates, to first order: the point turns with the
/// table by what A and C are behind, the light lags by what X, Y, Z, U, V and W are.
kinematics::Vector3 off_the_point(const RotaryTable& table, const std::array<double, kPathAxes.size()>& axes,
                                  const std::array<double, kPathAxes.size()>& behind);

}  // namespace gravure::texture
