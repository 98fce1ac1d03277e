#include "error_side.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mode_constants.hpp"

namespace gravure::motion {
namespace {

/// More nodes are not made; where they would be needed the envelope bounds what lies between.
constexpr double kMostCells = 2048;
/// Of a cubic through values and slopes: error <= fourth derivative * step^4 / this.
constexpr double kHermite = 384;

constexpr std::complex<double> kI{0, 1};

/// A cubic on [0, 1] by its values and slopes at both ends.
struct Cubic {
  double value[2];
  double slope[2];

  /// Control points: the cubic lies between the least and the greatest.
  std::array<double, 4> control() const noexcept {
    return {value[0], value[0] + slope[0] / 3, value[1] - slope[1] / 3, value[1]};
  }

  double at(double u) const noexcept {
    const auto c = control();
    const double v = 1 - u;
    return v * v * (v * c[0] + 3 * u * c[1]) + u * u * (3 * v * c[2] + u * c[3]);
  }

  double greatest() const noexcept {
    double most = std::max(value[0], value[1]);
    const double c2 = 3 * (value[1] - value[0]) - 2 * slope[0] - slope[1];
    const double c3 = 2 * (value[0] - value[1]) + slope[0] + slope[1];
    const double square = c2 * c2 - 3 * c3 * slope[0];
    if (square > 0) {
      // Both roots of slope0 + 2 c2 u + 3 c3 u^2, without cancellation.
      const double q = -(c2 + std::copysign(std::sqrt(square), c2));
      for (const double u : {q / (3 * c3), slope[0] / q}) {
        if (u > 0 && u < 1) {
          most = std::max(most, at(u));
        }
      }
    }
    return most;
  }

  Cubic negative() const noexcept { return {{-value[0], -value[1]}, {-slope[0], -slope[1]}}; }
};

}  // namespace

ErrorSide ErrorSide::over_frequency(const Mode& from, double to_f_hz, BandOf of, std::span<const InputJump> input,
                                    const SideAccuracy& accuracy) {
  return {Along::frequency, from, to_f_hz, of, input, accuracy};
}

ErrorSide ErrorSide::over_damping(const Mode& from, double to_zeta, BandOf of, std::span<const InputJump> input,
                                  const SideAccuracy& accuracy) {
  return {Along::damping, from, to_zeta, of, input, accuracy};
}

/// The parameter is the frequency as a multiple of the first, or asin(zeta): lambda = i w exp(i asin(zeta)) has no
/// derivative larger than w.
ErrorSide::ErrorSide(Along along, const Mode& from, double to, BandOf of, std::span<const InputJump> input,
                     const SideAccuracy& accuracy)
    : along_(along), from_(from), of_(of) {
  bound_parts(to, input);
  const bool frequency = along == Along::frequency;
  const double first = frequency ? 1 : std::asin(from.zeta);
  const double span = (frequency ? to / from.f_hz : std::asin(to)) - first;
  double most = 0;
  for (int i = 0; i <= 8; ++i) {
    most = std::max(most, fourth_derivative(accuracy.until_s * i / 8));
  }
  const double wanted = std::ceil(span / std::pow(kHermite * accuracy.error / most, 0.25));
  const auto cells = static_cast<std::size_t>(std::clamp(wanted, 1.0, kMostCells));
  step_ = span / static_cast<double>(cells);
  for (std::size_t i = 0; i <= cells; ++i) {
    nodes_.push_back(node_at(first + static_cast<double>(i) * step_, input));
  }
  const double off = off_by(0);
  for (std::size_t i = 0; i < cells; ++i) {
    const Node& a = nodes_[i];
    const Node& b = nodes_[i + 1];
    const double size = std::max({std::abs(a.value), std::abs(a.value + a.value_slope * (step_ / 3)),
                                  std::abs(b.value - b.value_slope * (step_ / 3)), std::abs(b.value)});
    cells_.push_back({size + off, std::min(-a.lambda.real(), -b.lambda.real())});
  }
}

/// Amplitude -p / (wd lambda^m) sum (dJ + lambda dA) exp(lambda tau), m = 2 for positions, and its derivative.
ErrorSide::Node ErrorSide::node_at(double parameter, std::span<const InputJump> input) const {
  Node node{from_, {}, {}, {}, {}};
  const bool frequency = along_ == Along::frequency;
  (frequency ? node.mode.f_hz : node.mode.zeta) = frequency ? from_.f_hz * parameter : std::sin(parameter);
  const ModeConstants m = constants_of(node.mode.f_hz, node.mode.zeta);
  node.lambda = m.lambda;
  const std::complex<double> relative = frequency ? std::complex<double>(1 / parameter) : kI;  // of lambda
  const double relative_wd = frequency ? 1 / parameter : -std::tan(parameter);
  node.lambda_slope = relative * m.lambda;
  std::complex<double> sum;
  std::complex<double> sum_slope;  // by lambda
  const double end_s = input.back().time_s;
  for (const InputJump& jump : input) {
    const double tau = end_s - jump.time_s;
    const std::complex<double> turned = exp_of(m, tau);
    const std::complex<double> weight = jump.jerk_jump_mm_s3 + m.lambda * jump.acceleration_jump_mm_s2;
    sum += times(weight, turned);
    sum_slope += times(jump.acceleration_jump_mm_s2 + tau * weight, turned);
  }
  const bool position = of_ == BandOf::position;
  std::complex<double> slope = times(sum_slope, node.lambda_slope) - sum * relative_wd;
  if (position) {
    slope -= 2.0 * times(sum, relative);
    sum = twice_integrated(sum, m);
    slope = twice_integrated(slope, m);
  }
  const double scale = -node.mode.participation / m.rad_per_s;
  node.value = scale * sum;
  node.value_slope = scale * slope;
  return node;
}

/// exp(lambda(x) t) has fourth derivatives of at most (w t + 2)^4; wd, lambda^m and lambda dA add to the 2 what their
/// own derivatives are relative to them.
void ErrorSide::bound_parts(double to, std::span<const InputJump> input) {
  const bool frequency = along_ == Along::frequency;
  const ModeConstants low = constants_of(from_.f_hz, from_.zeta);
  const ModeConstants high = frequency ? constants_of(to, from_.zeta) : constants_of(from_.f_hz, to);
  const double least_wd = std::min(low.rad_per_s, high.rad_per_s);
  rate_ = low.w;
  rest_ = frequency ? 7 : 5 + 6 * low.w / least_wd;
  least_decay_per_s_ = std::min(low.decay_per_s, high.decay_per_s);
  largest_decay_per_s_ = std::max(low.decay_per_s, high.decay_per_s);
  largest_w_ = high.w;
  const double scale = 2 * std::abs(from_.participation) / least_wd / (of_ == BandOf::position ? low.w * low.w : 1.0);
  for (const InputJump& jump : input) {
    parts_.push_back({scale * (std::abs(jump.jerk_jump_mm_s3) + high.w * std::abs(jump.acceleration_jump_mm_s2)),
                      input.back().time_s - jump.time_s});
  }
}

double ErrorSide::fourth_derivative(double after_s) const noexcept {
  double sum = 0;
  for (const Part& part : parts_) {
    const double time_s = part.before_end_s + after_s;
    const double turn = rate_ * time_s + rest_;
    sum += part.size * std::exp(-least_decay_per_s_ * time_s) * turn * turn * turn * turn;
  }
  return sum;
}

double ErrorSide::off_by(double after_s) const noexcept {
  return fourth_derivative(after_s) * step_ * step_ * step_ * step_ / kHermite;
}

double ErrorSide::envelope(double after_s) const noexcept {
  double most = 0;
  for (const Cell& cell : cells_) {
    most = std::max(most, cell.size * std::exp(-cell.decay_per_s * after_s));
  }
  return most;
}

std::size_t ErrorSide::reach(double after_s, Reach& reach) const {
  const double off = off_by(after_s);
  double value = 0;
  double slope = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    const double decayed = std::exp(node.lambda.real() * after_s);
    const double angle = node.lambda.imag() * after_s;
    const std::complex<double> turned{decayed * std::cos(angle), decayed * std::sin(angle)};
    const double next_value = times(node.value, turned).imag();
    const double next_slope =
        step_ * times(node.value_slope + after_s * times(node.lambda_slope, node.value), turned).imag();
    if (i > 0) {
      const Cell& cell = cells_[i - 1];
      const double most = cell.size * std::exp(-cell.decay_per_s * after_s);
      reach.envelope = std::max(reach.envelope, most);
      const Cubic cubic{{value, next_value}, {slope, next_slope}};
      const auto control = cubic.control();
      const auto [low, high] = std::minmax_element(control.begin(), control.end());
      if (std::min(most, *high + off) > reach.high) {
        const double greatest = std::min(most, cubic.greatest() + off);
        if (greatest > reach.high) {
          reach.high = greatest;
          reach.high_mode = nodes_[value > next_value ? i - 1 : i].mode;
        }
      }
      if (std::max(-most, *low - off) < reach.low) {
        const double least = std::max(-most, -cubic.negative().greatest() - off);
        if (least < reach.low) {
          reach.low = least;
          reach.low_mode = nodes_[value < next_value ? i - 1 : i].mode;
        }
      }
    }
    value = next_value;
    slope = next_slope;
  }
  return nodes_.size();
}

}  // namespace gravure::motion
