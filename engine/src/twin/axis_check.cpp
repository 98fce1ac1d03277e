#include "axis_check.hpp"

#include <utility>

#include "gravure/core/board_runs.hpp"
#include "gravure/core/spin_phase.hpp"

namespace gravure {
namespace {

__extension__ using Wide = __int128;
__extension__ using UnsignedWide = unsigned __int128;

Rational counts_per_step(const AbPlan& ab) {
  return Rational(ab.increment) + Rational(Integer(ab.fraction_num), Integer(ab.fraction_den));
}

Rational lag_of(const AbPlan& ab) {
  const Integer edge = Integer(1) << static_cast<unsigned>(ab.counter_bits - 2);
  const Rational waiting = counts_per_step(ab) * ratio(Integer(ab.prescaler) - 1, Integer(ab.prescaler));
  const int unfilled = ab.fraction_den > 1 ? 1 : 0;
  return (waiting + unfilled) / Rational(edge) + 1;
}

}  // namespace

/// What an axis is to do.
struct AxisCheck::Demand {
  const char* name;
  const AbPlan& ab;
  const std::optional<AxisSpin>& spin;
  Rational edges_per_revolution;
  Rational travel_um;         ///< in a revolution
  Rational largest_drift_um;  ///< from this on what is marked is in another's place
  bool to_and_fro = false;
};

Result<AxisCheck> AxisCheck::make(const Plan& plan) {
  return make(plan, {"axis", plan.ab, plan.spin, plan.rotary.edges_per_revolution, plan.rotary.circumference_um,
                     plan.rotary.line_pitch_um / 2, plan.mode == Mode::flat});
}

Result<AxisCheck> AxisCheck::make_carriage(const Plan& plan) {
  const CarriagePlan& carriage = *plan.carriage;
  return make(plan, {"carriage", carriage.ab, carriage.spin, carriage.edges_per_revolution, carriage.feed_um,
                     plan.line.pixel_pitch_um / 2});
}

Result<AxisCheck> AxisCheck::make(const Plan& plan, const Demand& demand) {
  const AbPlan& ab = demand.ab;
  if (ab.counter_bits < 3 || ab.counter_bits > 64 || ab.prescaler == 0 || ab.fraction_den == 0) {
    return Error{ErrorCode::out_of_range,
                 "the program's A-B registers: counter_bits = " + std::to_string(ab.counter_bits) +
                     " (3 to 64), prescaler = " + std::to_string(ab.prescaler) +
                     " and fraction_den = " + std::to_string(ab.fraction_den) + " (1 or more): compile it again"};
  }
  const Rational edges = demand.edges_per_revolution / plan.rotary.lines_per_revolution;
  if (edges <= 0) {
    return Error{ErrorCode::out_of_range,
                 std::string(demand.name) + ": " + to_string(edges) + " A-B edges a line: must be above 0"};
  }
  AxisCheck check;
  check.name_ = demand.name;
  check.lines_per_run_ = run_with(plan, 0).revolutions * plan.rotary.lines_per_revolution;
  check.to_and_fro_ = demand.to_and_fro;
  check.line_ticks_ = plan.line.ticks;
  check.edges_per_line_ = edges;
  if (constexpr std::int64_t kMost = std::int64_t{1} << 62;
      numerator_of(edges) <= kMost && denominator_of(edges) <= kMost) {
    check.edges_num_ = static_cast<std::int64_t>(numerator_of(edges));
    check.edges_den_ = static_cast<std::int64_t>(denominator_of(edges));
  }
  check.counter_shift_ = static_cast<unsigned>(ab.counter_bits - 2);
  check.prescaler_ = ab.prescaler;
  check.increment_ = ab.increment;
  check.fraction_num_ = ab.fraction_num;
  check.fraction_den_ = ab.fraction_den;
  check.largest_lag_edges_ = lag_of(ab);
  check.take_spin(ab, demand.spin);
  check.way_back_lead_edges_ = demand.to_and_fro ? to_double(way_back_lead(plan)) : 0;
  check.step_um_ = to_double(Rational(demand.travel_um / demand.edges_per_revolution));
  // Counts a line by the registers, over the counts it needs: what the counter gains.
  const Rational counts_per_line = counts_per_step(ab) * plan.line.ticks / Rational(Integer(ab.prescaler));
  check.drift_per_line_ = counts_per_line / (edges * Rational(Integer(Integer(1) << (ab.counter_bits - 2)))) - 1;
  if (check.drift_per_line_ != 0) {
    const Rational travel_per_line_um = demand.travel_um / plan.rotary.lines_per_revolution;
    const Integer first = ceil_of(Rational(demand.largest_drift_um / travel_per_line_um / abs(check.drift_per_line_)));
    check.first_misplaced_line_ = fits_int64(first) ? static_cast<std::int64_t>(first) : -1;
  }
  return check;
}

/// The state that the spin-up leaves at the first line of a run, and what is put out in all of it.
void AxisCheck::take_spin(const AbPlan& ab, const std::optional<AxisSpin>& spin) {
  if (!spin) {
    return;
  }
  const SpinStart start = spin_start(ab, spin);
  start_counts_ = start.counts;
  start_accumulator_ = start.accumulator;
  largest_lead_edges_ =
      (Rational(Integer(start.counts)) + Rational(Integer(start.accumulator), Integer(ab.fraction_den))) /
      Rational(Integer(1) << static_cast<unsigned>(ab.counter_bits - 2));
  spun_up_counts_ = spin->up.counts;
  SpinPhase phase{spin->up.counts, start_accumulator_};
  phase = phase_after(ab, ab.increment, lines_per_run_ * line_ticks_, std::move(phase));
  rest_counts_ = phase.counts + spin->down.counts;
}

std::optional<Integer> AxisCheck::rest_counts(std::int64_t ordinal) const {
  return rest_counts_ ? std::optional<Integer>(*rest_counts_ * sign_of(ordinal)) : std::nullopt;
}

std::int64_t AxisCheck::edges_in_run(std::int64_t ordinal, std::int64_t tick) const noexcept {
  const std::int64_t begin = (ordinal - ordinal % lines_per_run_) * line_ticks_;
  return static_cast<std::int64_t>(register_edges(tick - begin)) * sign_of(ordinal);
}

std::uint64_t AxisCheck::register_edges(std::int64_t tick) const noexcept {
  const std::uint64_t steps = static_cast<std::uint64_t>(tick) / prescaler_;
  UnsignedWide counts = static_cast<UnsignedWide>(steps) * increment_ + start_counts_;
  if (fraction_num_ != 0) {
    counts += (static_cast<UnsignedWide>(steps) * fraction_num_ + start_accumulator_) / fraction_den_;
  }
  return static_cast<std::uint64_t>(counts >> counter_shift_);
}

Rational AxisCheck::exact_error_at_end(std::int64_t ordinal, std::int64_t edges) const {
  const std::int64_t lines = ordinal % lines_per_run_ + 1;
  return Rational(Integer(edges) * sign_of(ordinal)) - Rational(lines) * edges_per_line_;
}

double AxisCheck::error_edges(std::int64_t ordinal, const AxisState& axis) const {
  if (edges_num_ == 0) {  // pitches of very many digits
    return to_double(
        Rational(Rational(axis.edges * sign_of(ordinal)) - Rational(ordinal % lines_per_run_) * edges_per_line_));
  }
  const Wide ideal = static_cast<Wide>(ordinal % lines_per_run_) * edges_num_;
  const Wide whole = ideal / edges_den_;
  const Wide rest = ideal % edges_den_;
  const Wide apart = static_cast<Wide>(axis.edges) * sign_of(ordinal) - whole;
  const double lead = sign_of(ordinal) < 0 ? way_back_lead_edges_ : 0;
  return static_cast<double>(apart) - static_cast<double>(rest) / static_cast<double>(edges_den_) + lead;
}

Result<AxisChecks> AxisChecks::make(const Plan& plan) {
  AxisChecks checks;
  GRAVURE_TRY(checks.cross_scan, AxisCheck::make(plan));
  if (plan.carriage) {
    GRAVURE_TRY(checks.carriage, AxisCheck::make_carriage(plan));
  }
  return checks;
}

}  // namespace gravure
