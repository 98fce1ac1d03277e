#include "axis_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "gravure/core/spin_phase.hpp"

namespace gravure {
namespace {

__extension__ using UnsignedWide = unsigned __int128;

/// Edges that a step of the prescaler adds, exact.
Rational edges_per_step(const AbPlan& ab) {
  return (Rational(ab.increment) + Rational(Integer(ab.fraction_num), Integer(ab.fraction_den))) /
         Rational(Integer(Integer(1) << static_cast<unsigned>(ab.counter_bits - 2)));
}

/// What `value` has beyond a multiple of `unit`.
Rational beyond(const Rational& value, const Rational& unit) {
  return value - unit * Rational(floor_of(Rational(value / unit)));
}

/// Pulses come every `slot` ticks. The lag is what waits for the next step of the prescaler, a multiple of their common
/// divisor beyond what had waited before, and what waits in the counter for the next edge, a multiple of
/// 1 / (denominator of the edges added) beyond what a spin-up left there, `begun`.
Rational largest_lag(const AbPlan& ab, std::int64_t slot, const Rational& begun, std::uint64_t waited) {
  const Rational step = edges_per_step(ab);
  const std::uint64_t common = std::gcd(ab.prescaler, static_cast<std::uint64_t>(slot));
  const Rational waiting = step * ratio(Integer(ab.prescaler) - common + waited % common, Integer(ab.prescaler));
  const bool whole = static_cast<std::uint64_t>(slot) % ab.prescaler == 0;
  const Rational added = whole ? Rational(step * Rational(static_cast<std::uint64_t>(slot) / ab.prescaler)) : step;
  const Rational unit = ratio(1, denominator_of(added));
  return waiting + 1 - unit + beyond(begun, unit);
}

/// Edges come with the step of the prescaler that completes them: in the mean so much after the steady signal would
/// have them.
Rational mean_lateness(const AbPlan& ab) {
  const Rational step = edges_per_step(ab);
  return (step - ratio(1, denominator_of(step))) / 2;
}

/// Revolutions that follow each other from one start of the axes.
std::int64_t revolutions_per_start(const Plan& plan) {
  return plan.mode == Mode::flat ? 1 : revolutions_per_band(plan);
}

}  // namespace

/// What an axis is to do.
struct AxisMotion::Demand {
  const char* name;
  const AbPlan& ab;
  Rational edges_per_revolution;
  Rational travel_um;  ///< in a revolution
  const std::optional<AxisSpin>& spin;
};

Result<AxisMotion> AxisMotion::make(const Plan& plan, const AxisTerms& terms) {
  return make(plan, {"axis", plan.ab, plan.rotary.edges_per_revolution, plan.rotary.circumference_um, plan.spin},
              terms);
}

Result<AxisMotion> AxisMotion::make_carriage(const Plan& plan, const AxisTerms& terms) {
  const CarriagePlan& carriage = *plan.carriage;
  return make(plan, {"carriage", carriage.ab, carriage.edges_per_revolution, carriage.feed_um, carriage.spin}, terms);
}

Result<AxisMotion> AxisMotion::make(const Plan& plan, const Demand& demand, const AxisTerms& terms) {
  const AbPlan& ab = demand.ab;
  if (ab.counter_bits < 3 || ab.counter_bits > 64 || ab.prescaler == 0 || ab.fraction_den == 0 ||
      (ab.increment == 0 && ab.fraction_num == 0) || demand.edges_per_revolution <= 0 ||
      plan.clock.ticks_per_slot < 1) {
    return Error{ErrorCode::out_of_range,
                 std::string(demand.name) + ": the program's A-B registers (counter_bits = " +
                     std::to_string(ab.counter_bits) + ", prescaler = " + std::to_string(ab.prescaler) +
                     ", increment = " + std::to_string(ab.increment) + " + " + std::to_string(ab.fraction_num) + "/" +
                     std::to_string(ab.fraction_den) + ") move nothing: compile it again"};
  }
  AxisMotion axis;
  axis.terms_ = terms;
  axis.revolutions_per_start_ = std::max<std::int64_t>(1, revolutions_per_start(plan));
  axis.ticks_per_revolution_ = plan.rotary.lines_per_revolution * plan.line.ticks;
  axis.ticks_per_slot_ = static_cast<double>(plan.clock.ticks_per_slot);
  axis.mask_ = (std::uint64_t{1} << static_cast<unsigned>(ab.counter_bits - 2)) - 1;
  axis.prescaler_ = ab.prescaler;
  axis.increment_ = ab.increment;
  axis.fraction_num_ = ab.fraction_num;
  axis.fraction_den_ = ab.fraction_den;
  const Phase slot = axis.phase_at({}, plan.clock.ticks_per_slot);  // nothing begun yet
  axis.slot_counts_ = slot.counts;
  axis.slot_fraction_ = slot.fraction;
  axis.slot_waiting_ = slot.waiting;
  const Rational step = edges_per_step(ab);
  axis.edges_per_step_ = to_double(step);
  axis.edges_per_count_ = 1 / (static_cast<double>(axis.mask_) + 1);
  axis.edges_per_part_ = axis.edges_per_count_ / static_cast<double>(ab.fraction_den);
  axis.edges_per_tick_ = axis.edges_per_step_ / static_cast<double>(ab.prescaler);
  axis.late_edges_ = to_double(mean_lateness(ab));
  axis.take_start(ab, demand.spin, plan.clock.ticks_per_slot);
  axis.step_um_ = to_double(Rational(demand.travel_um / demand.edges_per_revolution));
  const Rational edges_per_tick = step / Rational(Integer(ab.prescaler));
  if (terms.drift) {
    const Rational wanted =
        demand.edges_per_revolution / (Rational(plan.rotary.lines_per_revolution) * Rational(plan.line.ticks));
    axis.drift_um_per_tick_ =
        to_double(Rational((edges_per_tick - wanted) * demand.travel_um / demand.edges_per_revolution));
  }
  if (terms.servo) {
    if (!(terms.bandwidth_hz > 0 && terms.damping > 0)) {
      return Error{ErrorCode::out_of_range, "twin.servo: bandwidth_hz and damping must be above 0"};
    }
    axis.servo_.emplace(terms.bandwidth_hz, terms.damping,
                        to_double(Rational(1 / (edges_per_tick * Rational(plan.clock.fpga_hz)))));
    axis.steady_um_ = -axis.servo_lag_um();
  }
  axis.way_back_lead_um_ = &ab == &plan.ab ? to_double(way_back_lead(plan)) * axis.step_um_ : 0;
  axis.set_range();
  return axis;
}

/// A spin-up leaves the counter on an edge or less than a step beyond it, and the prescaler where its rest has it.
void AxisMotion::take_start(const AbPlan& ab, const std::optional<AxisSpin>& spin, std::int64_t slot) {
  Rational begun = 0;
  if (spin) {
    const SpinStart start = spin_start(ab, spin);
    start_ = {start.counts, start.accumulator, static_cast<std::uint64_t>(spin->up.ticks) % ab.prescaler};
    begun = (Rational(Integer(start.counts)) + Rational(Integer(start.accumulator), Integer(ab.fraction_den))) /
            Rational(Integer(Integer(1) << static_cast<unsigned>(ab.counter_bits - 2)));
  }
  largest_lag_edges_ = to_double(largest_lag(ab, slot, begun, start_.waiting));
}

AxisMotion::Start AxisMotion::start_of(std::int64_t revolution) const noexcept {
  const bool back = (revolution & 1) != 0;  // only a panel has a way back
  return {(revolution - revolution % revolutions_per_start_) * ticks_per_revolution_,
          lead_um_ + (back ? way_back_lead_um_ : 0)};
}

AxisMotion::Phase AxisMotion::phase_at(const Start& start, std::int64_t tick) const noexcept {
  const UnsignedWide waited = static_cast<UnsignedWide>(tick - start.tick) + start_.waiting;
  const UnsignedWide steps = waited / prescaler_;
  const UnsignedWide parts = steps * fraction_num_ + start_.fraction;
  Phase phase;
  phase.waiting = static_cast<std::uint64_t>(waited % prescaler_);
  phase.fraction = static_cast<std::uint64_t>(parts % fraction_den_);
  phase.counts = static_cast<std::uint64_t>(steps * increment_ + parts / fraction_den_ + start_.counts) & mask_;
  return phase;
}

void AxisMotion::advance(Phase& phase) const noexcept {
  const auto add = [this, &phase](std::uint64_t counts, std::uint64_t fraction) {
    phase.counts += counts;
    if (phase.fraction >= fraction_den_ - fraction) {
      phase.fraction -= fraction_den_ - fraction;
      ++phase.counts;
    } else {
      phase.fraction += fraction;
    }
  };
  add(slot_counts_, slot_fraction_);
  phase.waiting += slot_waiting_;
  if (phase.waiting >= prescaler_) {
    phase.waiting -= prescaler_;
    add(increment_, fraction_num_);
  }
  phase.counts &= mask_;
}

double AxisMotion::lag_edges(const Phase& phase) const noexcept {
  return static_cast<double>(phase.counts) * edges_per_count_ + static_cast<double>(phase.fraction) * edges_per_part_ +
         static_cast<double>(phase.waiting) * edges_per_tick_;
}

/// Behind the steady signal. With a servo the edges count as evenly spaced, as late as they are in the mean.
double AxisMotion::behind_edges(const Phase& phase) const noexcept {
  const double lag = lag_edges(phase);
  if (!servo_) {
    return lag;
  }
  const double since = lag - late_edges_;
  const double share = since - std::floor(since);
  return late_edges_ + share + servo_->staircase_lag_edges(share);
}

void AxisMotion::set_range() noexcept {
  if (!terms_.ab_step) {
    range_ = {steady_um_, steady_um_};
    return;
  }
  lead_um_ = lag_edges(start_) * step_um_;
  range_ = {lead_um_ - largest_lag_edges_ * step_um_, lead_um_};
  if (servo_) {
    const Servo::Range behind = servo_->staircase_range();
    // Edges come early or late by up to half a step of what they are late in the mean.
    const double rounding = edges_per_step_ / 2 * servo_->step_variation();
    range_ = {lead_um_ - (late_edges_ + behind.most + rounding) * step_um_,
              lead_um_ - (late_edges_ + behind.least - rounding) * step_um_};
  }
  range_.least_um += std::min(0.0, way_back_lead_um_);
  range_.most_um += std::max(0.0, way_back_lead_um_);
}

}  // namespace gravure
