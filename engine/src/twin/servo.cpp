#include "servo.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gravure {
namespace {

/// So near to critical damping the two roots are one to rounding: taken this far above, which moves nothing by more
/// than its share of an edge.
constexpr double kNearCritical = 1e-4;

/// exp(z) - 1 without cancellation near 0.
std::complex<double> exp_minus_1(const std::complex<double>& z) {
  const double half = std::sin(z.imag() / 2);
  return {std::expm1(z.real()) * std::cos(z.imag()) - 2 * half * half, std::exp(z.real()) * std::sin(z.imag())};
}

/// A step overshoots by M, M^2, ... of itself on either side: from 0 to 1 + M, to 1 - M^2, ...
double variation_of(double damping) {
  if (damping >= 1) {
    return 1;
  }
  const double overshoot = std::exp(-std::numbers::pi * damping / std::sqrt(1 - damping * damping));
  return (1 + overshoot) / (1 - overshoot);
}

}  // namespace

Servo::Servo(double bandwidth_hz, double damping, double period_s)
    : period_s_(period_s), step_variation_(variation_of(damping)) {
  const double omega = 2 * std::numbers::pi * bandwidth_hz;
  ramp_lag_edges_ = 2 * damping / omega / period_s;
  const double zeta = std::abs(damping - 1) < kNearCritical ? 1 + kNearCritical : damping;
  const Complex apart = std::sqrt(Complex(zeta * zeta - 1));
  roots_[0] = omega * (-zeta + apart);
  roots_[1] = omega * (-zeta - apart);
  if (zeta > 1) {  // -zeta + sqrt(zeta^2 - 1) without cancellation
    roots_[0] = omega * omega / roots_[1];
  }
  // 1 - h(t) = (r1 exp(r0 t) - r0 exp(r1 t)) / (r1 - r0); of all edges t, t + T, t + 2 T, ... together.
  const Complex difference = roots_[1] - roots_[0];
  weights_[0] = roots_[1] / difference / -exp_minus_1(roots_[0] * period_s);
  weights_[1] = -roots_[0] / difference / -exp_minus_1(roots_[1] * period_s);
}

double Servo::staircase_lag_edges(double share) const noexcept {
  const double t = share * period_s_;
  if (roots_[0].imag() != 0) {  // the second term is the conjugate of the first
    const double angle = roots_[0].imag() * t;
    return 2 * std::exp(roots_[0].real() * t) *
           (weights_[0].real() * std::cos(angle) - weights_[0].imag() * std::sin(angle));
  }
  return weights_[0].real() * std::exp(roots_[0].real() * t) + weights_[1].real() * std::exp(roots_[1].real() * t);
}

Servo::Range Servo::staircase_range() const {
  // Between samples a curve stays within the parabola that its second derivative allows.
  const double bends = std::abs(weights_[0] * roots_[0] * roots_[0]) + std::abs(weights_[1] * roots_[1] * roots_[1]);
  const double wanted = std::ceil(std::sqrt(bends) * period_s_ * 64);
  const auto samples = static_cast<int>(std::clamp(wanted, 64.0, 65536.0));
  const double cell_s = period_s_ / samples;
  Range range{staircase_lag_edges(0), staircase_lag_edges(0)};
  for (int i = 1; i <= samples; ++i) {
    const double share = static_cast<double>(i) / samples;
    const double lag = share + staircase_lag_edges(share);
    range.least = std::min(range.least, lag);
    range.most = std::max(range.most, lag);
  }
  const double between = bends * cell_s * cell_s / 8;
  return {range.least - between, range.most + between};
}

}  // namespace gravure
