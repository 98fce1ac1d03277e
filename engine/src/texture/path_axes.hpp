#pragma once

#include <array>

#include "gravure/texture/axes.hpp"

namespace gravure::texture {

inline constexpr std::size_t kStageAxes = 5;

/// X, Y, Z, A, C.
inline std::array<double, kStageAxes> stages_of(const SevenAxes& at) noexcept {
  return {at.x_mm, at.y_mm, at.z_mm, at.a_rad, at.c_rad};
}

/// In the order of kPathAxes.
inline std::array<double, 7> values_of(const SevenAxes& at) noexcept {
  return {at.x_mm, at.y_mm, at.z_mm, at.a_rad, at.c_rad, at.u_mm, at.v_mm};
}

}  // namespace gravure::texture
