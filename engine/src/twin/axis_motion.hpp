#pragma once

#include <cstdint>
#include <optional>

#include "gravure/core/plan.hpp"
#include "servo.hpp"

namespace gravure {

/// What the terms of an axis are made of.
struct AxisTerms {
  bool drift = false;
  bool ab_step = false;
  bool servo = false;
  double bandwidth_hz = 0;
  double damping = 0;
};

/// How far an axis is from where its pulses want it, at any tick: the A-B edges of the registers (or the steady signal
/// they stand for), through the servo, against ideal motion. All in um of travel the way the axis goes; positive: it
/// leads. On the way back of a panel that is towards line 0 of the image.
class AxisMotion {
 public:
  /// The axis across the lines. Fails with out_of_range where the registers are none.
  static Result<AxisMotion> make(const Plan& plan, const AxisTerms& terms);
  /// The carriage of a helical plan.
  static Result<AxisMotion> make_carriage(const Plan& plan, const AxisTerms& terms);

  /// The A-B generator between two edges, for walking from slot to slot.
  struct Phase {
    std::uint64_t counts = 0;    ///< since the last edge, below 2^(n-2)
    std::uint64_t fraction = 0;  ///< of the second accumulator, below its denominator
    std::uint64_t waiting = 0;   ///< ticks since the last step of the prescaler
  };
  /// One pulse slot on.
  void advance(Phase& phase) const noexcept;
  /// How far the edges are behind the steady signal, in edges: 0 to largest_lag_edges().
  double lag_edges(const Phase& phase) const noexcept;
  double largest_lag_edges() const noexcept { return largest_lag_edges_; }

  /// Where motion starts, from rest or with the counter at 0: with the first line of the job, of a band, of a pass.
  struct Start {
    std::int64_t tick = 0;
    double lead_um = 0;  ///< of the steady signal against the edges, and of a way back against the pass
  };
  Start start_of(std::int64_t revolution) const noexcept;
  Phase phase_at(const Start& start, std::int64_t tick) const noexcept;
  /// What drift has added up to.
  double drift_um(const Start& start, std::int64_t tick) const noexcept {
    return drift_um_per_tick_ * static_cast<double>(tick - start.tick);
  }
  double drift_um_per_slot() const noexcept { return drift_um_per_tick_ * ticks_per_slot_; }
  /// Everything but the drift.
  double off_um(const Start& start, const Phase& phase) const noexcept {
    return !terms_.ab_step ? steady_um_ : start.lead_um - step_um_ * behind_edges(phase);
  }
  /// Between what off_um() is over the whole job; with a servo also what the rounding of edges to ticks may do to it,
  /// which off_um() leaves out.
  struct Range {
    double least_um = 0;
    double most_um = 0;
  };
  const Range& range() const noexcept { return range_; }
  double step_um() const noexcept { return step_um_; }
  double servo_lag_um() const noexcept { return servo_ ? servo_->ramp_lag_edges() * step_um_ : 0; }

 private:
  struct Demand;
  static Result<AxisMotion> make(const Plan& plan, const Demand& demand, const AxisTerms& terms);
  void take_start(const AbPlan& ab, const std::optional<AxisSpin>& spin, std::int64_t slot);
  double behind_edges(const Phase& phase) const noexcept;
  void set_range() noexcept;

  AxisTerms terms_;
  std::optional<Servo> servo_;
  std::int64_t revolutions_per_start_ = 1;
  std::int64_t ticks_per_revolution_ = 0;
  double ticks_per_slot_ = 1;
  std::uint64_t mask_ = 0;  ///< 2^(n-2) - 1
  std::uint64_t prescaler_ = 1;
  std::uint64_t increment_ = 0;
  std::uint64_t fraction_num_ = 0;
  std::uint64_t fraction_den_ = 1;
  Phase start_;         ///< what a spin-up leaves of an edge, of a count, of a step; else all 0
  double lead_um_ = 0;  ///< the steady signal is so far ahead of the edges then
  double way_back_lead_um_ = 0;
  double late_edges_ = 0;          ///< edges come later than evenly spaced ones by so much, in the mean
  std::uint64_t slot_counts_ = 0;  ///< what the whole steps of a slot add
  std::uint64_t slot_fraction_ = 0;
  std::uint64_t slot_waiting_ = 0;
  double edges_per_step_ = 0;  ///< of the prescaler
  double edges_per_count_ = 0;
  double edges_per_part_ = 0;  ///< of the second accumulator
  double edges_per_tick_ = 0;
  double largest_lag_edges_ = 0;
  double step_um_ = 0;
  double steady_um_ = 0;
  double drift_um_per_tick_ = 0;
  Range range_;
};

}  // namespace gravure
