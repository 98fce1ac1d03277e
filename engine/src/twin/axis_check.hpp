#pragma once

#include <cstdint>
#include <optional>

#include "gravure/core/line_device.hpp"
#include "gravure/core/plan.hpp"

namespace gravure {

/// Holds an axis of the device against the motion the plan's geometry asks for: at line L of a run (board_runs.hpp) it
/// must stand L / nL revolutions on from where the run's lines began, that is L * edges_per_revolution / nL A-B edges;
/// in backward passes as far the other way. Lines are counted over the whole job.
class AxisCheck {
 public:
  /// The axis across the lines. Fails with out_of_range where registers or geometry are none.
  static Result<AxisCheck> make(const Plan& plan);
  /// The carriage of a helical plan, likewise.
  static Result<AxisCheck> make_carriage(const Plan& plan);

  /// Device minus ideal at a line start, in edges the way the run goes (positive: the axis leads): whole edges exact,
  /// the ideal's part below one edge to 1e-15.
  double error_edges(std::int64_t ordinal, const AxisState& axis) const;
  /// A-B edges the registers put out in the first `tick` FPGA ticks of a run, at most 2^63 - 1: whole steps of the
  /// prescaler, each with its increment and its share of the fraction, floor(counts / 2^(n-2)), with what the spin-up
  /// left of an edge and of a count. Exact.
  std::uint64_t register_edges(std::int64_t tick) const noexcept;
  /// Where that puts the axis at tick `tick` of the job in the run of line `ordinal`: below 0 in backward passes.
  std::int64_t edges_in_run(std::int64_t ordinal, std::int64_t tick) const noexcept;
  /// Device minus ideal, as above, at the end of line `ordinal`, exact.
  Rational exact_error_at_end(std::int64_t ordinal, std::int64_t edges) const;
  /// How far the edges may lag behind the drift: the edge that is about to come, with a prescaler the step that is, and
  /// the part of a count that the fraction has not filled. The lag is below this.
  const Rational& largest_lag_edges() const noexcept { return largest_lag_edges_; }
  /// How far they may lead: what a spin-up left of an edge and of a count.
  const Rational& largest_lead_edges() const noexcept { return largest_lead_edges_; }
  /// What the channel is to put out before the first line of the run that has line `ordinal`, in counts with sign.
  Integer spun_up_counts(std::int64_t ordinal) const { return spun_up_counts_ * sign_of(ordinal); }
  /// And from rest to rest; none where the plan has no spin-down.
  std::optional<Integer> rest_counts(std::int64_t ordinal) const;
  double step_um() const noexcept { return step_um_; }
  std::int64_t lines_per_run() const noexcept { return lines_per_run_; }
  /// "axis" or "carriage", for messages.
  const char* name() const noexcept { return name_; }

  /// Drift of the counter alone, without its steps: exact, in lines per line. Positive: the axis leads.
  const Rational& drift_per_line() const noexcept { return drift_per_line_; }
  /// From this line of a run on, the drift is half a line (carriage: half a column) or more: what is marked lands on
  /// a neighbour's place. -1: never.
  std::int64_t first_misplaced_line() const noexcept { return first_misplaced_line_; }

 private:
  struct Demand;
  static Result<AxisCheck> make(const Plan& plan, const Demand& demand);
  void take_spin(const AbPlan& ab, const std::optional<AxisSpin>& spin);
  int sign_of(std::int64_t ordinal) const noexcept {
    return to_and_fro_ && (ordinal / lines_per_run_) % 2 != 0 ? -1 : 1;
  }

  const char* name_ = "axis";
  std::int64_t lines_per_run_ = 1;
  bool to_and_fro_ = false;  ///< every other run goes backward
  std::int64_t line_ticks_ = 0;
  Rational edges_per_line_ = 0;  ///< ideal
  std::int64_t edges_num_ = 0;   ///< the same as num / den, where both are below 2^62; else 0
  std::int64_t edges_den_ = 1;
  unsigned counter_shift_ = 0;  ///< n - 2
  std::uint64_t prescaler_ = 1;
  std::uint64_t increment_ = 0;
  std::uint64_t fraction_num_ = 0;
  std::uint64_t fraction_den_ = 1;
  double way_back_lead_edges_ = 0;
  Rational largest_lag_edges_ = 1;
  Rational largest_lead_edges_ = 0;
  std::uint64_t start_counts_ = 0;  ///< of an edge, at the first line of a run
  std::uint64_t start_accumulator_ = 0;
  Integer spun_up_counts_ = 0;
  std::optional<Integer> rest_counts_;
  double step_um_ = 0;
  Rational drift_per_line_ = 0;
  std::int64_t first_misplaced_line_ = -1;
};

/// Both axes of a plan.
struct AxisChecks {
  AxisCheck cross_scan;
  std::optional<AxisCheck> carriage;

  static Result<AxisChecks> make(const Plan& plan);
};

}  // namespace gravure
