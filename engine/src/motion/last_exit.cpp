#include "last_exit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "mode_constants.hpp"

namespace gravure::motion {
namespace {

/// The signal and its derivatives at one instant.
struct Instant {
  double after_s = 0;
  double value = 0;
  double slope = 0;
  double curvature = 0;
};

/// Bounds that hold from one instant on: envelopes of the derivatives there.
struct Bounds {
  double curvature = 0;
  double third = 0;
};

/// Goes back in time in strides. Between two instants the signal lies off their chord by at most length^2 / 8 times its
/// curvature, which proves most strides; the others are cut where slope or curvature provably keep their sign, so that
/// no exit between two instants is missed.
class BackwardWalk {
 public:
  BackwardWalk(std::span<const ResidualSignal::Term> terms, double tolerance) noexcept
      : terms_(terms), tolerance_(tolerance), band_(tolerance * (1 - 1e-12)) {
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      amplitude_[i] = std::abs(terms_[i].amplitude);
    }
  }

  double run(double from_s) noexcept {
    Instant right = anchor(from_s);
    if (std::abs(right.value) >= band_) {
      return from_s;
    }
    choose_stride();
    for (unsigned count = 1; right.after_s > 0; ++count) {
      // Turning on from instant to instant rounds; start afresh now and then.
      const Instant left = count % 64 == 0 ? anchor(right.after_s - stride_s_) : turn_back(right.after_s - stride_s_);
      const Bounds bounds = bounds_here();
      if (!chord_holds(left, right, bounds)) {
        if (const auto exit_s = exit_between(left, right, bounds, 60)) {
          return std::max(0.0, *exit_s);
        }
      }
      right = left;
    }
    return 0;
  }

 private:
  ModeConstants constants(std::size_t i) const noexcept { return {0, terms_[i].decay_per_s, terms_[i].rad_per_s, {}}; }

  void add(Instant& instant, std::size_t i, const std::complex<double>& z) const noexcept {
    const double decay = terms_[i].decay_per_s;
    const double rad = terms_[i].rad_per_s;
    const double real = -decay * z.real() - rad * z.imag();
    const double imag = -decay * z.imag() + rad * z.real();
    instant.value += z.imag();
    instant.slope += imag;
    instant.curvature += -decay * imag + rad * real;
  }

  Instant at(double after_s) const noexcept {
    Instant instant{after_s};
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      add(instant, i, times(terms_[i].amplitude, exp_of(constants(i), after_s)));
    }
    return instant;
  }

  /// Sets the walk to an instant.
  Instant anchor(double after_s) noexcept {
    Instant instant{after_s};
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const double decayed = std::exp(-terms_[i].decay_per_s * after_s);
      const double angle = terms_[i].rad_per_s * after_s;
      now_[i] = times(terms_[i].amplitude, {decayed * std::cos(angle), decayed * std::sin(angle)});
      size_[i] = amplitude_[i] * decayed;
      add(instant, i, now_[i]);
    }
    return instant;
  }

  /// As long as the chord may be off by a twentieth of the tolerance at the start: longer strides prove less, shorter
  /// ones are more.
  void choose_stride() noexcept {
    double curvature = 0;
    double fastest_decay = 0;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const double square = terms_[i].decay_per_s * terms_[i].decay_per_s + terms_[i].rad_per_s * terms_[i].rad_per_s;
      square_[i] = square;
      cube_[i] = square * std::sqrt(square);
      curvature += square * size_[i];
      fastest_decay = std::max(fastest_decay, terms_[i].decay_per_s);
    }
    stride_s_ = std::sqrt(8 * 0.05 * tolerance_ / curvature);
    if (fastest_decay > 0) {
      stride_s_ = std::min(stride_s_, 0.5 / fastest_decay);
    }
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      grow_[i] = std::exp(terms_[i].decay_per_s * stride_s_);
      const double angle = terms_[i].rad_per_s * stride_s_;
      turn_[i] = {grow_[i] * std::cos(angle), -grow_[i] * std::sin(angle)};
    }
  }

  Instant turn_back(double after_s) noexcept {
    Instant instant{after_s};
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      now_[i] = times(now_[i], turn_[i]);
      size_[i] *= grow_[i];
      add(instant, i, now_[i]);
    }
    return instant;
  }

  /// Derivatives from the walk's instant on.
  Bounds bounds_here() const noexcept {
    Bounds bounds;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      bounds.curvature += square_[i] * size_[i];
      bounds.third += cube_[i] * size_[i];
    }
    return bounds;
  }

  bool chord_holds(const Instant& left, const Instant& right, const Bounds& bounds) const noexcept {
    const double length = right.after_s - left.after_s;
    return std::max(std::abs(left.value), std::abs(right.value)) + bounds.curvature * length * length / 8 <= band_;
  }

  bool outside(const Instant& instant) const noexcept { return std::abs(instant.value) >= band_; }

  /// The last exit in [left, right], where right is inside.
  std::optional<double> exit_between(const Instant& left, const Instant& right, const Bounds& bounds,
                                     int halvings) const noexcept {
    const double length = right.after_s - left.after_s;
    if (chord_holds(left, right, bounds)) {
      return std::nullopt;
    }
    const bool same_way = left.slope * right.slope > 0;
    const double bent = left.curvature * right.curvature > 0
                            ? std::abs(left.curvature) + std::abs(right.curvature) - bounds.third * length
                            : 0;
    if (same_way && (bent > 0 || std::abs(left.slope) + std::abs(right.slope) > bounds.curvature * length)) {
      return outside(left) ? std::optional(crossing(left, right, bounds.curvature)) : std::nullopt;
    }
    if (bent > 0) {
      const Instant top = extreme(left, right, bent / 2);
      if (outside(top)) {
        return crossing(top, right, bounds.curvature);
      }
      return outside(left) ? std::optional(crossing(left, top, bounds.curvature)) : std::nullopt;
    }
    if (halvings == 0) {
      return outside(left) ? std::optional(left.after_s) : std::nullopt;
    }
    const Instant middle = at(left.after_s + length / 2);
    if (!outside(middle)) {
      if (const auto exit_s = exit_between(middle, right, bounds, halvings - 1)) {
        return exit_s;
      }
      return exit_between(left, middle, bounds, halvings - 1);
    }
    return exit_between(middle, right, bounds, halvings - 1);
  }

  /// The only extreme value between two instants whose slopes differ in sign, near enough to be told from the band, or
  /// an instant outside it. `least` bounds the curvature from below.
  Instant extreme(const Instant& left, const Instant& right, double least) const noexcept {
    double low_s = left.after_s;
    double high_s = right.after_s;
    double next_s = low_s + (high_s - low_s) * left.slope / (left.slope - right.slope);
    Instant top = right;
    for (int step = 0; step < 60; ++step) {
      top = at(next_s);
      const double beyond = top.slope * top.slope / (2 * least);  // what the extreme value can add
      if (outside(top) || std::abs(top.value) + beyond < band_ || beyond < 1e-14 * tolerance_) {
        break;
      }
      (top.slope * left.slope > 0 ? low_s : high_s) = next_s;
      next_s = top.after_s - top.slope / top.curvature;
      if (!(next_s > low_s && next_s < high_s)) {
        next_s = low_s + (high_s - low_s) / 2;
      }
    }
    return top;
  }

  /// Where the signal comes in between an instant outside and a later one inside, with one crossing between them and
  /// no more curvature than `most_curved`.
  double crossing(const Instant& out, const Instant& in, double most_curved) const noexcept {
    const double sign = out.value > 0 ? 1 : -1;
    double low_s = out.after_s;
    double high_s = in.after_s;
    const double excess = std::max(0.0, sign * out.value - tolerance_);
    // By the parabola at the outer instant, which also serves close to an extreme value.
    const double slope = -sign * out.slope;
    const double square = slope * slope + 2 * -sign * out.curvature * excess;
    double next_s = low_s + 2 * excess / (slope + std::sqrt(std::max(0.0, square)));
    for (int step = 0; step < 100; ++step) {
      if (!(next_s > low_s && next_s < high_s)) {
        next_s = low_s + (high_s - low_s) / 2;
        if (!(next_s > low_s && next_s < high_s)) {
          break;
        }
      }
      const Instant now = at(next_s);
      const double off = sign * now.value - tolerance_;
      (off > 0 ? low_s : high_s) = next_s;
      const double correction_s = off / (sign * now.slope);
      next_s -= correction_s;
      if (most_curved * correction_s * correction_s <= 1e-13 * tolerance_) {
        return next_s;  // what Newton leaves is less than half of this
      }
    }
    return low_s;
  }

  std::span<const ResidualSignal::Term> terms_;
  double tolerance_;
  double band_;  ///< what counts as outside
  double stride_s_ = 0;
  std::array<double, kMaxModes> amplitude_{};
  std::array<std::complex<double>, kMaxModes> now_{};
  std::array<std::complex<double>, kMaxModes> turn_{};  ///< exp(-lambda stride)
  std::array<double, kMaxModes> size_{};                ///< |now_|
  std::array<double, kMaxModes> grow_{};                ///< |turn_|
  std::array<double, kMaxModes> square_{};              ///< |lambda|^2
  std::array<double, kMaxModes> cube_{};
};

}  // namespace

double last_exit_before(std::span<const ResidualSignal::Term> terms, double from_s, double tolerance) noexcept {
  return BackwardWalk(terms, tolerance).run(from_s);
}

}  // namespace gravure::motion
