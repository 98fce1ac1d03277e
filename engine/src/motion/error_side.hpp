#pragma once

#include <complex>
#include <limits>
#include <span>
#include <vector>

#include "gravure/motion/settling.hpp"

namespace gravure::motion {

/// What one mode can be at an instant, whatever its error, with errors that make it so.
struct Reach {
  double high = -std::numeric_limits<double>::infinity();
  double low = std::numeric_limits<double>::infinity();
  double envelope = 0;
  Mode high_mode;
  Mode low_mode;
};

struct SideAccuracy {
  double error = 0;    ///< that interpolation may make, in the band's unit
  double until_s = 0;  ///< for instants from the end of the input up to here
};

/// A side of the rectangle of one mode's errors: the mode's residual with one of frequency and damping in a range and
/// the other fixed. Between nodes the response is a cubic through its values and slopes at both; what it can be off by
/// is bounded by the fourth derivative of the sum over the input's jumps.
class ErrorSide {
 public:
  static ErrorSide over_frequency(const Mode& from, double to_f_hz, BandOf of, std::span<const InputJump> input,
                                  const SideAccuracy& accuracy);
  static ErrorSide over_damping(const Mode& from, double to_zeta, BandOf of, std::span<const InputJump> input,
                                const SideAccuracy& accuracy);

  /// Widens `reach` to all that the mode can be on this side; returns the number of nodes looked at.
  std::size_t reach(double after_s, Reach& reach) const;
  double envelope(double after_s) const noexcept;
  double largest_w() const noexcept { return largest_w_; }
  double largest_decay_per_s() const noexcept { return largest_decay_per_s_; }

 private:
  enum class Along : std::uint8_t { frequency, damping };
  struct Node {
    Mode mode;
    std::complex<double> lambda;
    std::complex<double> lambda_slope;
    std::complex<double> value;  ///< amplitude: the residual is Im(value exp(lambda t))
    std::complex<double> value_slope;
  };
  /// From one node to the next.
  struct Cell {
    double size = 0;  ///< bound of |value|
    double decay_per_s = 0;
  };
  /// One jump in the bound of the fourth derivative.
  struct Part {
    double size = 0;
    double before_end_s = 0;
  };

  ErrorSide(Along along, const Mode& from, double to, BandOf of, std::span<const InputJump> input,
            const SideAccuracy& accuracy);
  Node node_at(double parameter, std::span<const InputJump> input) const;
  void bound_parts(double to, std::span<const InputJump> input);
  double fourth_derivative(double after_s) const noexcept;
  double off_by(double after_s) const noexcept;

  Along along_;
  Mode from_;
  BandOf of_;
  double step_ = 0;  ///< of the parameter between nodes
  double rate_ = 0;  ///< derivatives of exp(lambda t) and of what it is multiplied with
  double rest_ = 0;
  double least_decay_per_s_ = 0;
  double largest_decay_per_s_ = 0;
  double largest_w_ = 0;
  std::vector<Part> parts_;
  std::vector<Node> nodes_;
  std::vector<Cell> cells_;
};

}  // namespace gravure::motion
