#pragma once

#include <cmath>
#include <complex>

#include "gravure/motion/vibration.hpp"

namespace gravure::motion {

inline constexpr double kTwoPi = 6.283185307179586476925286766559;

/// lambda = -zeta w + i w sqrt(1 - zeta^2) and what goes with it.
struct ModeConstants {
  double w = 0;
  double decay_per_s = 0;
  double rad_per_s = 0;
  std::complex<double> lambda;
};

inline ModeConstants constants_of(double f_hz, double zeta) noexcept {
  const double w = kTwoPi * f_hz;
  const double decay = zeta * w;
  const double rad = w * std::sqrt((1 - zeta) * (1 + zeta));
  return {w, decay, rad, {-decay, rad}};
}

/// Plain complex product: std::complex's operator also looks after infinities, which cost a call.
inline std::complex<double> times(const std::complex<double>& a, const std::complex<double>& b) noexcept {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

inline std::complex<double> exp_of(const ModeConstants& m, double time_s) noexcept {
  const double size = std::exp(-m.decay_per_s * time_s);
  return {size * std::cos(m.rad_per_s * time_s), size * std::sin(m.rad_per_s * time_s)};
}

/// From accelerations to the deviation in position: division by lambda^2.
inline std::complex<double> twice_integrated(const std::complex<double>& value, const ModeConstants& m) noexcept {
  return value / times(m.lambda, m.lambda);
}

}  // namespace gravure::motion
