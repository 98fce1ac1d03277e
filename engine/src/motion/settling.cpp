#include "gravure/motion/settling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "last_exit.hpp"
#include "mode_constants.hpp"

namespace gravure::motion {
namespace {

constexpr double kUnsettled = std::numeric_limits<double>::infinity();

/// The sum of the terms' sizes over time, against a tolerance.
class Envelope {
 public:
  Envelope(std::span<const ResidualSignal::Term> terms, double tolerance) noexcept
      : terms_(terms), tolerance_(tolerance) {
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      size_[i] = std::abs(terms_[i].amplitude);
      total_ += size_[i];
      if (terms_[i].decay_per_s > 0) {
        slowest_decay_ = std::min(slowest_decay_, terms_[i].decay_per_s);
      } else {
        undamped_ += size_[i];
      }
    }
  }

  bool settled_at_once() const noexcept { return !(total_ > tolerance_); }
  bool never_settles() const noexcept { return undamped_ >= tolerance_; }
  double trivial_time_s() const noexcept { return settled_at_once() ? 0 : kUnsettled; }

  /// When it reaches the tolerance, by Newton on the logarithm, which is convex and falls: it comes from the left and
  /// never passes the root.
  double time_s() const noexcept {
    double time_s = start_s();
    for (int step = 0; step < 100; ++step) {
      const Sum sum = at(time_s);
      const double advance = std::log(sum.value / tolerance_) * sum.value / sum.falling;
      if (!(advance > 1e-15 * time_s)) {
        break;
      }
      time_s += advance;
    }
    return time_s * (1 + 1e-13);
  }

  /// A little later than time_s() and found sooner: what is damped decays at least as the slowest. Newton goes on until
  /// that says little more than Newton itself; beside an undamped or slow mode that just fits the tolerance it would
  /// say nothing.
  double time_bound_s() const noexcept {
    double time_s = start_s();
    for (int step = 0; step < 100; ++step) {
      const Sum sum = at(time_s);
      const double excess = std::max(0.0, sum.value - tolerance_);
      const double advance = excess / sum.falling;
      const double over = excess / (tolerance_ - undamped_);
      const double bound = (over < 0.05 ? over : std::log1p(over)) / slowest_decay_;
      if (excess <= 0.05 * tolerance_ && (bound <= 4 * advance || excess <= 1e-12 * tolerance_)) {
        time_s += bound;
        break;
      }
      time_s += advance;
    }
    return time_s * (1 + 1e-13);
  }

 private:
  struct Sum {
    double value = 0;
    double falling = 0;
  };
  Sum at(double time_s) const noexcept {
    Sum sum;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const double now = size_[i] * std::exp(-terms_[i].decay_per_s * time_s);
      sum.value += now;
      sum.falling += terms_[i].decay_per_s * now;
    }
    return sum;
  }
  /// Before this one term alone is too large.
  double start_s() const noexcept {
    double time_s = 0;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (size_[i] > tolerance_) {  // so it is damped
        time_s = std::max(time_s, std::log(size_[i] / tolerance_) / terms_[i].decay_per_s);
      }
    }
    return time_s;
  }

  std::span<const ResidualSignal::Term> terms_;
  double tolerance_;
  double total_ = 0;
  double undamped_ = 0;
  double slowest_decay_ = kUnsettled;
  std::array<double, kMaxModes> size_{};
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
  const Envelope envelope(terms(), tolerance);
  return envelope.settled_at_once() || envelope.never_settles() ? envelope.trivial_time_s() : envelope.time_s();
}

double ResidualSignal::last_exit_s(double tolerance) const noexcept {
  const Envelope envelope(terms(), tolerance);
  return envelope.settled_at_once() || envelope.never_settles()
             ? envelope.trivial_time_s()
             : last_exit_before(terms(), envelope.time_bound_s(), tolerance);
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
