#include "axis_check.hpp"

namespace gravure {
namespace {

__extension__ using Wide = __int128;
__extension__ using UnsignedWide = unsigned __int128;

Rational counts_per_step(const AbPlan& ab) {
  return Rational(ab.increment) + Rational(Integer(ab.fraction_num), Integer(ab.fraction_den));
}

/// Counts a line by the registers, over the counts it needs: what the counter gains.
Rational drift_of(const Plan& plan) {
  const Rational counts_per_line = counts_per_step(plan.ab) * plan.line.ticks / Rational(Integer(plan.ab.prescaler));
  const Rational edges_per_line = plan.rotary.edges_per_revolution / plan.rotary.lines_per_revolution;
  const Rational wanted = edges_per_line * Rational(Integer(Integer(1) << (plan.ab.counter_bits - 2)));
  return counts_per_line / wanted - 1;
}

Rational lag_of(const AbPlan& ab) {
  const Integer edge = Integer(1) << static_cast<unsigned>(ab.counter_bits - 2);
  const Rational waiting = counts_per_step(ab) * ratio(Integer(ab.prescaler) - 1, Integer(ab.prescaler));
  const int unfilled = ab.fraction_den > 1 ? 1 : 0;
  return (waiting + unfilled) / Rational(edge) + 1;
}

}  // namespace

Result<AxisCheck> AxisCheck::make(const Plan& plan) {
  const AbPlan& ab = plan.ab;
  if (ab.counter_bits < 3 || ab.counter_bits > 64 || ab.prescaler == 0 || ab.fraction_den == 0) {
    return Error{ErrorCode::out_of_range,
                 "the program's A-B registers: counter_bits = " + std::to_string(ab.counter_bits) +
                     " (3 to 64), prescaler = " + std::to_string(ab.prescaler) +
                     " and fraction_den = " + std::to_string(ab.fraction_den) + " (1 or more): compile it again"};
  }
  const Rational edges = plan.rotary.edges_per_revolution / plan.rotary.lines_per_revolution;
  constexpr std::int64_t kMost = std::int64_t{1} << 62;
  if (edges <= 0 || numerator_of(edges) > kMost || denominator_of(edges) > kMost) {
    return Error{ErrorCode::out_of_range,
                 "rotary: " + to_string(edges) + " A-B edges a line are beyond 62-bit integers"};
  }
  AxisCheck check;
  check.edges_num_ = static_cast<std::int64_t>(numerator_of(edges));
  check.edges_den_ = static_cast<std::int64_t>(denominator_of(edges));
  check.counter_shift_ = static_cast<unsigned>(ab.counter_bits - 2);
  check.prescaler_ = ab.prescaler;
  check.increment_ = ab.increment;
  check.fraction_num_ = ab.fraction_num;
  check.fraction_den_ = ab.fraction_den;
  check.largest_lag_edges_ = lag_of(ab);
  check.step_um_ = to_double(Rational(plan.rotary.circumference_um / plan.rotary.edges_per_revolution));
  check.drift_per_line_ = drift_of(plan);
  if (check.drift_per_line_ != 0) {
    const Integer first = ceil_of(Rational(Rational(1, 2) / abs(check.drift_per_line_)));
    check.first_misplaced_line_ = fits_int64(first) ? static_cast<std::int64_t>(first) : -1;
  }
  return check;
}

std::uint64_t AxisCheck::register_edges(std::int64_t tick) const noexcept {
  const std::uint64_t steps = static_cast<std::uint64_t>(tick) / prescaler_;
  UnsignedWide counts = static_cast<UnsignedWide>(steps) * increment_;
  if (fraction_num_ != 0) {
    counts += static_cast<UnsignedWide>(steps) * fraction_num_ / fraction_den_;
  }
  return static_cast<std::uint64_t>(counts >> counter_shift_);
}

Rational AxisCheck::exact_error_edges(std::int64_t ordinal, std::uint64_t edges) const {
  return Rational(Integer(edges)) - ratio(Integer(ordinal) * edges_num_, edges_den_);
}

double AxisCheck::error_edges(std::int64_t ordinal, const AxisState& axis) const {
  const Wide ideal = static_cast<Wide>(ordinal) * edges_num_;
  const Wide whole = ideal / edges_den_;
  const Wide rest = ideal % edges_den_;
  const Wide apart = static_cast<Wide>(axis.edges) - whole;
  return static_cast<double>(apart) - static_cast<double>(rest) / static_cast<double>(edges_den_);
}

}  // namespace gravure
