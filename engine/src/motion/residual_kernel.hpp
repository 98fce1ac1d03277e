#pragma once

#include <array>
#include <complex>
#include <span>

#include "gravure/motion/settling.hpp"
#include "mode_constants.hpp"

namespace gravure::motion {

/// A feasible published-form move from rest to rest by its durations: tu, td >= tj >= 0, cruise >= 0.
struct Durations {
  double jerk_s = 0;    ///< tj
  double up_s = 0;      ///< V / Au
  double down_s = 0;    ///< V / Ad
  double cruise_s = 0;  ///< Tv
  double access_time_s() const noexcept { return 2 * jerk_s + up_s + down_s + cruise_s; }
  /// X / V.
  double stroke_over_velocity_s() const noexcept { return cruise_s + jerk_s + (up_s + down_s) / 2; }
};

/// exp(lambda t) for one duration and every mode.
using Turns = std::array<std::complex<double>, kMaxModes>;

/// The residual of a seven-segment move in four exponentials a mode. The eight jumps factor:
/// sum dJ_k exp(lambda (t7 - t_k)) = (Ej - 1) [ (Au/tj) (Eu - 1) Ev Ed Ej - (Ad/tj) (Ed - 1) ],  E = exp(lambda
/// duration), from [C1]'s times; (Ej - 1)/tj is lambda where tj is 0.
class ResidualKernel {
 public:
  ResidualKernel(std::span<const Mode> modes, BandOf of) noexcept;
  std::size_t count() const noexcept { return count_; }
  Turns turns(double duration_s) const noexcept;
  ResidualSignal residual(const Durations& d, double velocity) const noexcept;
  /// The same from turns that are known already.
  ResidualSignal residual(const Turns& jerk, const Turns& up, const Turns& down, const Turns& cruise,
                          const Durations& d, double velocity) const noexcept;

 private:
  std::array<ModeConstants, kMaxModes> modes_{};
  std::array<std::complex<double>, kMaxModes> scale_{};  ///< -p / wd, for positions also / lambda^2
  std::size_t count_ = 0;
};

}  // namespace gravure::motion
