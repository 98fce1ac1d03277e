#include "servo_step.hpp"

#include <cmath>
#include <numbers>

#include "gravure/core/path_expand.hpp"

namespace gravure::texture {

ServoStep::ServoStep(const ServoLoop& loop, double servo_s) noexcept {
  const double w = 2 * std::numbers::pi * loop.natural_hz * servo_s;
  const double away = loop.damping * w;
  const double root2 = w * w * (1 - loop.damping * loop.damping);  // below 0: two real roots, no wave
  const double root = std::sqrt(std::abs(root2));
  constexpr double kSeries = 1e-3;  // of sin(x) / x and sinh(x) / x; the next term is x^4 / 120
  // exp(-away t) cos(root t) and exp(-away t) sin(root t) / root after a period, or the same of cosh and sinh.
  double wave = 0;
  double lean = 0;
  if (root2 >= 0) {
    wave = std::exp(-away) * std::cos(root);
    lean = std::exp(-away) * (root < kSeries ? 1 - root2 / 6 : std::sin(root) / root);
  } else {
    const double slow = std::exp(-w * w / (away + root));
    const double fast = std::exp(-away - root);
    wave = (slow + fast) / 2;
    lean = root < kSeries ? std::exp(-away) * (1 - root2 / 6) : (slow - fast) / (2 * root);
  }
  stiffness_ = w * w;
  drag_ = 2 * away;
  decay_ = {{{wave + away * lean, lean}, {-stiffness_ * lean, wave - away * lean}}};
}

void ServoStep::step(const std::array<double, 4>& x) noexcept {
  const CubicMotion begin = cubic_motion(x, 0);
  // The right side, powers of the share of the period; then the parabola that solves it.
  const double second = drag_ * begin.jerk / 2 / stiffness_;
  const double first = (begin.jerk + drag_ * begin.acceleration - 2 * drag_ * second) / stiffness_;
  const double constant = (begin.acceleration + drag_ * begin.speed - drag_ * first - 2 * second) / stiffness_;
  const double off = behind_ - constant;
  const double off_rate = rate_ + (begin.speed - speed_) - first;
  behind_ = constant + first + second + decay_[0][0] * off + decay_[0][1] * off_rate;
  rate_ = first + 2 * second + decay_[1][0] * off + decay_[1][1] * off_rate;
  speed_ = begin.speed + begin.acceleration + begin.jerk / 2;
}

}  // namespace gravure::texture
