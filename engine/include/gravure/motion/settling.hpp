#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <span>

#include "gravure/motion/vibration.hpp"

namespace gravure::motion {

/// A sum of decaying oscillations, Im(sum B_i exp(lambda_i t)) from the end of the input on.
class ResidualSignal {
 public:
  struct Term {
    std::complex<double> amplitude;  ///< B_i
    double decay_per_s = 0;          ///< zeta w
    double rad_per_s = 0;            ///< w sqrt(1 - zeta^2)
  };
  void add(const Term& term) noexcept;
  std::span<const Term> terms() const noexcept { return {terms_.data(), count_}; }

  double at(double after_s) const noexcept;
  /// Never below the signal and never rising: the sum of the amplitudes.
  double envelope(double after_s) const noexcept;
  /// From when on the envelope is within `tolerance` (> 0); infinite where undamped terms alone exceed it.
  double envelope_time_s(double tolerance) const noexcept;
  /// The last instant at which the signal is beyond `tolerance`, 0 if it never is, infinite where the envelope's is.
  /// Walks back from envelope_time_s() in steps within which the signal provably cannot leave, so no exit is missed.
  double last_exit_s(double tolerance) const noexcept;

 private:
  std::array<Term, kMaxModes> terms_{};
  std::size_t count_ = 0;
};

enum class BandOf : std::uint8_t { acceleration, position };

/// When a move counts as done: the signal stays within +-tolerance (mm/s^2 or mm).
struct Band {
  BandOf of = BandOf::acceleration;
  double tolerance = 0;
};

struct Settling {
  double access_time_s = 0;       ///< the input ends
  double positioning_time_s = 0;  ///< last instant outside the band, at least the access time
  double envelope_time_s = 0;     ///< the same of the envelope: later, but smooth in every parameter
  double residual_after_s() const noexcept { return positioning_time_s - access_time_s; }
};

/// The free vibration after the last jump of the input ([C1]; closed form, no time stepping).
ResidualSignal residual_of(std::span<const Mode> modes, std::span<const InputJump> input, BandOf of) noexcept;

/// An input without jumps is settled at 0. Fails with out_of_range for modes check_modes() refuses and for a tolerance
/// that is not above 0.
Result<Settling> settle(std::span<const Mode> modes, std::span<const InputJump> input, const Band& band);

}  // namespace gravure::motion
