#pragma once

#include <cstdint>

#include "gravure/core/device_link.hpp"
#include "gravure/core/plan.hpp"

namespace gravure {

/// Holds the axis of the device against the turning the plan's geometry asks for: at line L of the job the axis must
/// stand at L / nL revolutions, that is L * edges_per_revolution / nL A-B edges.
class AxisCheck {
 public:
  /// Fails with out_of_range when the edges of a line, as a ratio in lowest terms, are beyond 62-bit integers.
  static Result<AxisCheck> make(const Plan& plan);

  /// Device minus ideal at a line start, in edges: whole edges exact, the ideal's part below one edge to 1e-15.
  double error_edges(std::int64_t ordinal, const AxisState& axis) const;
  /// A-B edges the registers put out in `tick` FPGA ticks, at most 2^63 - 1: whole steps of the prescaler, each with
  /// its increment and its share of the fraction, floor(counts / 2^(n-2)). Exact.
  std::uint64_t register_edges(std::int64_t tick) const noexcept;
  /// Device minus ideal at the start of line `ordinal` (the number of lines: the end of the last), exact.
  Rational exact_error_edges(std::int64_t ordinal, std::uint64_t edges) const;
  /// How far the edges may lag behind the drift: the edge that is about to come, with a prescaler the step that is, and
  /// the part of a count that the fraction has not filled. The lag is below this.
  const Rational& largest_lag_edges() const noexcept { return largest_lag_edges_; }
  double step_um() const noexcept { return step_um_; }

  /// Drift of the counter alone, without its steps: exact, in lines per line. Positive: the axis leads.
  const Rational& drift_per_line() const noexcept { return drift_per_line_; }
  /// From this line of the job on, the drift is half a line or more: the line lands on a neighbour's place. -1: never.
  std::int64_t first_misplaced_line() const noexcept { return first_misplaced_line_; }

 private:
  std::int64_t edges_num_ = 0;  ///< ideal edges a line = num / den
  std::int64_t edges_den_ = 1;
  unsigned counter_shift_ = 0;  ///< n - 2
  std::uint64_t prescaler_ = 1;
  std::uint64_t increment_ = 0;
  std::uint64_t fraction_num_ = 0;
  std::uint64_t fraction_den_ = 1;
  Rational largest_lag_edges_ = 1;
  double step_um_ = 0;
  Rational drift_per_line_ = 0;
  std::int64_t first_misplaced_line_ = -1;
};

}  // namespace gravure
