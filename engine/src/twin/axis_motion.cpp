#include "axis_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace gravure {
namespace {

__extension__ using UnsignedWide = unsigned __int128;

/// Edges that a step of the prescaler adds, exact.
Rational edges_per_step(const AbPlan& ab) {
  return (Rational(ab.increment) + Rational(Integer(ab.fraction_num), Integer(ab.fraction_den))) /
         Rational(Integer(Integer(1) << static_cast<unsigned>(ab.counter_bits - 2)));
}

/// Pulses come every `slot` ticks. The lag is what waits for the next step of the prescaler, a multiple of their common
/// divisor, and what waits in the counter for the next edge, a multiple of 1 / (denominator of the edges added).
Rational largest_lag(const AbPlan& ab, std::int64_t slot) {
  const Rational step = edges_per_step(ab);
  const std::uint64_t common = std::gcd(ab.prescaler, static_cast<std::uint64_t>(slot));
  const Rational waiting = step * ratio(Integer(ab.prescaler) - common, Integer(ab.prescaler));
  const bool whole = static_cast<std::uint64_t>(slot) % ab.prescaler == 0;
  const Rational added = whole ? Rational(step * Rational(static_cast<std::uint64_t>(slot) / ab.prescaler)) : step;
  return waiting + 1 - ratio(1, denominator_of(added));
}

}  // namespace

/// What an axis is to do.
struct AxisMotion::Demand {
  const char* name;
  const AbPlan& ab;
  Rational edges_per_revolution;
  Rational travel_um;         ///< in a revolution
  bool starts_again = false;  ///< with every revolution
};

Result<AxisMotion> AxisMotion::make(const Plan& plan, const AxisTerms& terms) {
  return make(
      plan, {"axis", plan.ab, plan.rotary.edges_per_revolution, plan.rotary.circumference_um, plan.mode == Mode::flat},
      terms);
}

Result<AxisMotion> AxisMotion::make_carriage(const Plan& plan, const AxisTerms& terms) {
  const CarriagePlan& carriage = *plan.carriage;
  return make(plan, {"carriage", carriage.ab, carriage.edges_per_revolution, carriage.feed_um}, terms);
}

Result<AxisMotion> AxisMotion::make(const Plan& plan, const Demand& demand, const AxisTerms& terms) {
  const AbPlan& ab = demand.ab;
  if (ab.counter_bits < 3 || ab.counter_bits > 64 || ab.prescaler == 0 || ab.fraction_den == 0 || ab.increment == 0 ||
      demand.edges_per_revolution <= 0 || plan.clock.ticks_per_slot < 1) {
    return Error{ErrorCode::out_of_range,
                 std::string(demand.name) + ": the program's A-B registers (counter_bits = " +
                     std::to_string(ab.counter_bits) + ", prescaler = " + std::to_string(ab.prescaler) +
                     ", increment = " + std::to_string(ab.increment) + ") move nothing: compile it again"};
  }
  AxisMotion axis;
  axis.terms_ = terms;
  axis.ticks_per_start_ = demand.starts_again ? plan.rotary.lines_per_revolution * plan.line.ticks : 0;
  axis.ticks_per_slot_ = static_cast<double>(plan.clock.ticks_per_slot);
  axis.mask_ = (std::uint64_t{1} << static_cast<unsigned>(ab.counter_bits - 2)) - 1;
  axis.prescaler_ = ab.prescaler;
  axis.increment_ = ab.increment;
  axis.fraction_num_ = ab.fraction_num;
  axis.fraction_den_ = ab.fraction_den;
  const Phase slot = axis.phase_at(plan.clock.ticks_per_slot);
  axis.slot_counts_ = slot.counts;
  axis.slot_fraction_ = slot.fraction;
  axis.slot_waiting_ = slot.waiting;
  const Rational step = edges_per_step(ab);
  axis.edges_per_step_ = to_double(step);
  axis.edges_per_count_ = 1 / (static_cast<double>(axis.mask_) + 1);
  axis.edges_per_part_ = axis.edges_per_count_ / static_cast<double>(ab.fraction_den);
  axis.edges_per_tick_ = axis.edges_per_step_ / static_cast<double>(ab.prescaler);
  axis.largest_lag_edges_ = to_double(largest_lag(ab, plan.clock.ticks_per_slot));
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
  axis.set_range(plan);
  return axis;
}

AxisMotion::Phase AxisMotion::phase_at(std::int64_t tick) const noexcept {
  const std::uint64_t steps = static_cast<std::uint64_t>(tick) / prescaler_;
  const UnsignedWide parts = static_cast<UnsignedWide>(steps) * fraction_num_;
  Phase phase;
  phase.waiting = static_cast<std::uint64_t>(tick) % prescaler_;
  phase.fraction = static_cast<std::uint64_t>(parts % fraction_den_);
  phase.counts = (steps * increment_ + static_cast<std::uint64_t>(parts / fraction_den_)) & mask_;
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

/// Behind the steady signal. With a servo the edges count as evenly spaced.
double AxisMotion::behind_edges(const Phase& phase) const noexcept {
  const double lag = lag_edges(phase);
  if (!servo_) {
    return lag;
  }
  const double share = lag - std::floor(lag);
  return share + servo_->staircase_lag_edges(share);
}

AxisMotion::Start AxisMotion::start_of(std::int64_t revolution) const noexcept {
  Start start;
  if (ticks_per_start_ > 0) {
    start.tick = revolution * ticks_per_start_;
    start.lag_um = terms_.ab_step ? lag_edges(phase_at(start.tick)) * step_um_ : 0;
  }
  return start;
}

void AxisMotion::set_range(const Plan& plan) noexcept {
  if (!terms_.ab_step) {
    range_ = {steady_um_, steady_um_};
    return;
  }
  range_ = {-largest_lag_edges_ * step_um_, 0};
  if (servo_) {
    const Servo::Range behind = servo_->staircase_range();
    const double rounding = edges_per_step_ * servo_->step_variation();
    range_ = {-(behind.most + rounding) * step_um_, -(behind.least - rounding) * step_um_};
  }
  double least = 0;
  double most = 0;
  for (std::int64_t pass = 0; ticks_per_start_ > 0 && pass < plan.job.revolutions; ++pass) {
    const double lag_um = start_of(pass).lag_um;
    least = pass == 0 ? lag_um : std::min(least, lag_um);
    most = std::max(most, lag_um);
  }
  range_.least_um += least;
  range_.most_um += most;
}

}  // namespace gravure
