#pragma once

#include <complex>

namespace gravure {

/// An axis that follows its A-B signal as x'' = w^2 (command - x) - 2 zeta w x', after everything that starting has
/// left in it has died away. Positions are in A-B edges.
class Servo {
 public:
  /// `period_s`: from edge to edge of a signal that has its edges evenly spaced. All above 0.
  Servo(double bandwidth_hz, double damping, double period_s);

  /// How far it is behind a steady ramp of one edge a period: 2 zeta v / w.
  double ramp_lag_edges() const noexcept { return ramp_lag_edges_; }
  /// How far it is behind the edges that have come, `share` (0 to 1) of a period after the last of them: the sum of
  /// what each edge has still to do, a geometric series.
  double staircase_lag_edges(double share) const noexcept;
  /// Total variation of the response to one edge: edges that come up to j periods late change where the axis is by less
  /// than j times this.
  double step_variation() const noexcept { return step_variation_; }
  /// Least and largest of share + staircase_lag_edges(share), how far the axis is behind the ramp.
  struct Range {
    double least;
    double most;
  };
  Range staircase_range() const;

 private:
  using Complex = std::complex<double>;

  double period_s_;
  double ramp_lag_edges_;
  double step_variation_;
  Complex roots_[2];    ///< of the characteristic equation
  Complex weights_[2];  ///< of exp(root * time since the last edge)
};

}  // namespace gravure
