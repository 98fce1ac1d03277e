#pragma once

#include <array>

#include "gravure/texture/following_error.hpp"

namespace gravure::texture {

/// A loop from set-point to set-point. What it is behind, e = r - y, obeys e'' + 2 zeta w e' + w^2 e = r'' + 2 zeta w
/// r', w in radians a period: along a cubic r the right side is a parabola, so e is another parabola and what dies away
/// of the difference.
class ServoStep {
 public:
  ServoStep(const ServoLoop& loop, double servo_s) noexcept;
  /// One period on, along the cubic of four set-points.
  void step(const std::array<double, 4>& x) noexcept;
  double behind() const noexcept { return behind_; }

 private:
  double stiffness_ = 0;  ///< w^2
  double drag_ = 0;       ///< 2 zeta w
  std::array<std::array<double, 2>, 2> decay_{};
  double behind_ = 0;
  double rate_ = 0;   ///< of behind_, a period
  double speed_ = 0;  ///< of the set-points at the end of the last period: the next cubic may begin with another
};

}  // namespace gravure::texture
