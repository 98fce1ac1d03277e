#include "gravure/motion/settling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mode_constants.hpp"

namespace gravure::motion {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The signal at an instant that walks back in time.
class BackwardWalk {
 public:
  BackwardWalk(std::span<const ResidualSignal::Term> terms, double after_s) noexcept
      : terms_(terms), after_s_(after_s) {
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const auto& term = terms_[i];
      const ModeConstants m{0, term.decay_per_s, term.rad_per_s, {}};
      now_[i] = times(term.amplitude, exp_of(m, after_s));
      fastest_decay_ = std::max(fastest_decay_, term.decay_per_s);
      square_[i] = term.decay_per_s * term.decay_per_s + term.rad_per_s * term.rad_per_s;
    }
  }

  double after_s() const noexcept { return after_s_; }
  double value() const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      sum += now_[i].imag();
    }
    return sum;
  }

  /// A step back within which |signal| provably stays within the tolerance: Taylor with a bound of the curvature, which
  /// grows by at most exp(1/2) over half a time constant.
  double safe_step(double value, double tolerance) const noexcept {
    double slope = 0;
    double curvature = 0;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      slope += -terms_[i].decay_per_s * now_[i].imag() + terms_[i].rad_per_s * now_[i].real();
      curvature += square_[i] * (std::abs(now_[i].real()) + std::abs(now_[i].imag()));
    }
    curvature *= 1.6487212707001282;
    const double up = tolerance - value;
    const double down = tolerance + value;
    const double step_up = 2 * up / (-slope + std::sqrt(slope * slope + 2 * curvature * up));
    const double step_down = 2 * down / (slope + std::sqrt(slope * slope + 2 * curvature * down));
    const double longest = fastest_decay_ > 0 ? 0.5 / fastest_decay_ : kNever;
    return std::min({step_up, step_down, longest});
  }

  void step_back(double step_s) noexcept {
    after_s_ -= step_s;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const ModeConstants m{0, terms_[i].decay_per_s, terms_[i].rad_per_s, {}};
      now_[i] = times(now_[i], exp_of(m, -step_s));
    }
  }

 private:
  std::span<const ResidualSignal::Term> terms_;
  double after_s_;
  double fastest_decay_ = 0;
  std::array<std::complex<double>, kMaxModes> now_{};
  std::array<double, kMaxModes> square_{};
};

}  // namespace

void ResidualSignal::add(const Term& term) noexcept {
  if (count_ < kMaxModes) {
    terms_[count_++] = term;
  }
}

double ResidualSignal::at(double after_s) const noexcept {
  double sum = 0;
  for (const Term& term : terms()) {
    sum += times(term.amplitude, exp_of({0, term.decay_per_s, term.rad_per_s, {}}, after_s)).imag();
  }
  return sum;
}

double ResidualSignal::envelope(double after_s) const noexcept {
  double sum = 0;
  for (const Term& term : terms()) {
    sum += std::abs(term.amplitude) * std::exp(-term.decay_per_s * after_s);
  }
  return sum;
}

double ResidualSignal::envelope_time_s(double tolerance) const noexcept {
  std::array<double, kMaxModes> size{};
  double undamped = 0;
  double total = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    size[i] = std::abs(terms_[i].amplitude);
    total += size[i];
    undamped += terms_[i].decay_per_s > 0 ? 0 : size[i];
  }
  if (!(total > tolerance)) {
    return 0;
  }
  if (undamped >= tolerance) {
    return kNever;
  }
  // Newton on the logarithm, which is convex and falls: it comes from the left and never passes the root.
  double time_s = 0;
  for (int step = 0; step < 100; ++step) {
    double sum = 0;
    double falling = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double now = size[i] * std::exp(-terms_[i].decay_per_s * time_s);
      sum += now;
      falling += terms_[i].decay_per_s * now;
    }
    const double advance = std::log(sum / tolerance) * sum / falling;
    if (!(advance > 1e-15 * time_s)) {
      break;
    }
    time_s += advance;
  }
  return time_s * (1 + 1e-13);
}

double ResidualSignal::last_exit_s(double tolerance) const noexcept {
  const double from_s = envelope_time_s(tolerance);
  if (!(from_s > 0) || from_s == kNever) {
    return from_s;
  }
  BackwardWalk walk(terms(), from_s);
  while (walk.after_s() > 0) {
    const double value = walk.value();
    if (std::abs(value) >= tolerance * (1 - 1e-12)) {
      return walk.after_s();
    }
    walk.step_back(walk.safe_step(value, tolerance));
  }
  return 0;
}

ResidualSignal residual_of(std::span<const Mode> modes, std::span<const InputJump> input, BandOf of) noexcept {
  ResidualSignal signal;
  const double end_s = input.empty() ? 0 : input.back().time_s;
  for (const Mode& mode : modes) {
    const ModeConstants m = constants_of(mode.f_hz, mode.zeta);
    std::complex<double> sum;
    for (const InputJump& jump : input) {
      const std::complex<double> weight = jump.jerk_jump_mm_s3 + m.lambda * jump.acceleration_jump_mm_s2;
      sum += times(weight, exp_of(m, end_s - jump.time_s));
    }
    if (of == BandOf::position) {
      sum = twice_integrated(sum, m);
    }
    signal.add({sum * (-mode.participation / m.rad_per_s), m.decay_per_s, m.rad_per_s});
  }
  return signal;
}

Result<Settling> settle(std::span<const Mode> modes, std::span<const InputJump> input, const Band& band) {
  GRAVURE_CHECK(check_modes(modes));
  if (!(band.tolerance > 0 && band.tolerance <= 1e300)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("motion: settle: tolerance = {}: must be finite and above 0", band.tolerance)};
  }
  const ResidualSignal signal = residual_of(modes, input, band.of);
  const double end_s = input.empty() ? 0 : input.back().time_s;
  return Settling{end_s, end_s + signal.last_exit_s(band.tolerance), end_s + signal.envelope_time_s(band.tolerance)};
}

}  // namespace gravure::motion
