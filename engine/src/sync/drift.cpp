#include "gravure/sync/drift.hpp"

namespace gravure {

Rational drift_lines_after(const Plan& plan, const Integer& lines) {
  return plan.ab.drift_lines_per_revolution * wanted_turns_at_line(plan, lines);
}

Rational drift_um_after(const Plan& plan, const Integer& lines) {
  return plan.ab.drift_um_per_revolution * wanted_turns_at_line(plan, lines);
}

Seam seam_after_revolution(const Plan& plan, const Integer& revolution) {
  const Rational turns = Rational(revolution) + Rational(1);
  return {.step_um = plan.ab.drift_um_per_revolution,
          .accumulated_lines = plan.ab.drift_lines_per_revolution * turns,
          .accumulated_um = plan.ab.drift_um_per_revolution * turns};
}

Rational wanted_turns_at_line(const Plan& plan, const Integer& line) {
  return Rational(line, Integer(plan.rotary.lines_per_revolution));
}

Rational wanted_edges_at_line(const Plan& plan, const Integer& line) {
  return wanted_turns_at_line(plan, line) * plan.rotary.edges_per_revolution;
}

Rational emitted_edges_at_line(const Plan& plan, const Integer& line) {
  return wanted_edges_at_line(plan, line) * (plan.ab.output_hz / plan.ab.wanted_hz);
}

}  // namespace gravure
