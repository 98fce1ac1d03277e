#pragma once

#include <array>

#include "gravure/core/path_motion.hpp"
#include "gravure/texture/axes.hpp"

namespace gravure::texture {

inline constexpr std::size_t kStageAxes = 5;

/// Between two points of a path: `share` 0 to 1 of the way from point `index` to the next. Apart, because a number of
/// points as one double is too coarse for third differences.
struct Place {
  std::size_t index = 0;
  double share = 0;
  double points() const noexcept { return static_cast<double>(index) + share; }
};

/// X, Y, Z, A, C.
inline std::array<double, kStageAxes> stages_of(const SevenAxes& at) noexcept {
  return {at.x_mm, at.y_mm, at.z_mm, at.a_rad, at.c_rad};
}

/// In the order of kPathAxes, as if there were a focus axis.
inline std::array<double, kPathAxes.size()> values_of(const SevenAxes& at) noexcept {
  return {at.x_mm, at.y_mm, at.z_mm, at.a_rad, at.c_rad, at.u_mm, at.v_mm, at.w_mm};
}

}  // namespace gravure::texture
