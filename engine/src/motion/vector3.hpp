#pragma once

#include <cmath>
#include <numbers>

#include "gravure/motion/five_axis.hpp"

namespace gravure::motion {

inline constexpr double kDegree = std::numbers::pi / 180;

inline double length_of(const Vector3& v) noexcept {
  return std::hypot(v[0], v[1], v[2]);
}

inline double distance(const Vector3& a, const Vector3& b) noexcept {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace gravure::motion
