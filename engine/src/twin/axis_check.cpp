#include "axis_check.hpp"

namespace gravure {
namespace {

__extension__ using Wide = __int128;

/// Counts a line by the registers, over the counts it needs: what the counter gains.
Rational drift_of(const Plan& plan) {
  const Rational per_step = Rational(plan.ab.increment) + Rational(Integer(plan.ab.fraction_num), plan.ab.fraction_den);
  const Rational counts_per_line = per_step * plan.line.ticks / Rational(Integer(plan.ab.prescaler));
  const Rational edges_per_line = plan.rotary.edges_per_revolution / plan.rotary.lines_per_revolution;
  const Rational wanted = edges_per_line * Rational(Integer(Integer(1) << (plan.ab.counter_bits - 2)));
  return counts_per_line / wanted - 1;
}

}  // namespace

Result<AxisCheck> AxisCheck::make(const Plan& plan) {
  const Rational edges = plan.rotary.edges_per_revolution / plan.rotary.lines_per_revolution;
  constexpr std::int64_t kMost = std::int64_t{1} << 62;
  if (edges <= 0 || numerator_of(edges) > kMost || denominator_of(edges) > kMost) {
    return Error{ErrorCode::out_of_range,
                 "rotary: " + to_string(edges) + " A-B edges a line are beyond 62-bit integers"};
  }
  AxisCheck check;
  check.edges_num_ = static_cast<std::int64_t>(numerator_of(edges));
  check.edges_den_ = static_cast<std::int64_t>(denominator_of(edges));
  check.step_um_ = to_double(Rational(plan.rotary.circumference_um / plan.rotary.edges_per_revolution));
  check.drift_per_line_ = drift_of(plan);
  if (check.drift_per_line_ != 0) {
    const Integer first = ceil_of(Rational(Rational(1, 2) / abs(check.drift_per_line_)));
    check.first_misplaced_line_ = fits_int64(first) ? static_cast<std::int64_t>(first) : -1;
  }
  return check;
}

double AxisCheck::error_edges(std::int64_t ordinal, const AxisState& axis) const {
  const Wide ideal = static_cast<Wide>(ordinal) * edges_num_;
  const Wide whole = ideal / edges_den_;
  const Wide rest = ideal % edges_den_;
  const Wide apart = static_cast<Wide>(axis.edges) - whole;
  return static_cast<double>(apart) - static_cast<double>(rest) / static_cast<double>(edges_den_);
}

}  // namespace gravure
