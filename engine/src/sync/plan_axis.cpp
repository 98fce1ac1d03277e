#include "plan_axis.hpp"

#include <algorithm>
#include <utility>

#include "check_job.hpp"
#include "gravure/core/line_device.hpp"
#include "line_window.hpp"

namespace gravure::sync_plan {
namespace {

/// Highest A-B frequency: what the motion control takes, or one edge per FPGA clock ([B] eq. 2).
Rational reachable_hz(const AxisRequest& axis, const Plan& plan) {
  return std::min(Rational(axis.max_ab_hz), ratio(plan.clock.fpga_hz, 4));
}

std::string reach_limit(const AxisRequest& axis, const Plan& plan) {
  if (Rational(axis.max_ab_hz) <= ratio(plan.clock.fpga_hz, 4)) {
    return axis.section + ".max_ab_hz = " + std::to_string(axis.max_ab_hz);
  }
  return "what the counter can emit, a quarter of the FPGA clock = " + number_text(ratio(plan.clock.fpga_hz, 4)) +
         " Hz (increment <= 2^(n-2))";
}

/// What would bring the wanted frequency down to what can be emitted, each alone.
std::string what_would_fit(const Job& job, const Plan& plan, const AxisRequest& axis, std::int64_t slots) {
  const Rational excess = wanted_hz(plan, axis, slots) / reachable_hz(axis, plan);
  std::vector<std::string> ways;
  int bits = axis.interpolation_bits;
  for (Rational left = excess; left > 1 && bits >= 0; left /= 2) {
    --bits;
  }
  if (bits >= 0) {
    ways.push_back(axis.section + ".interpolation_bits <= " + std::to_string(bits));
  }
  if (axis.section != "rotary") {
    ways.push_back("a " + axis.section + ".encoder_pitch_um of at least " + number_text(axis.scale * excess));
  } else if (const Rational gear = axis.scale / excess; gear * Rational(kMostGearTurns) >= Rational(1)) {
    ways.push_back("a rotary.gear ratio of at most " + number_text(gear));
  }
  const Integer least_slots =
      ceil_of(excess * Rational(slots) / Rational(plan.line.slots_per_microvector)) * plan.line.slots_per_microvector;
  if (least_slots - plan.line.pixels <= kMostTurnSlots && least_slots <= kMostSlotsPerLine) {
    ways.push_back("lines of at least " + to_string(least_slots) +
                   " slots (scanner.turn_slots >= " + to_string(Integer(least_slots - plan.line.pixels)) + ")");
  }
  if (const Integer divider = ceil_of(excess * Rational(job.laser.pulse_divider)); divider <= kMostSeedsPerSlot) {
    ways.push_back("laser.pulse_divider >= " + to_string(divider));
  }
  if (ways.empty()) {
    return "no single key within its range would fit";
  }
  std::string text;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == ways.size() ? " or " : ", ") + ways[i];
  }
  return text + " would fit";
}

Result<AbSolution> solve(const Job& job, const Plan& plan, const AxisRequest& axis, std::int64_t slots) {
  const int bits = job.fpga.counter_bits;
  const Rational fpga_hz = plan.clock.fpga_hz;
  AbSolution solution;
  solution.wanted_increment = increment_per_clock(wanted_hz(plan, axis, slots), bits, fpga_hz);
  if (axis.fraction) {
    GRAVURE_TRY(solution.fraction, exact_fraction(solution.wanted_increment, bits));
    solution.pair = {.prescaler = 1, .increment = solution.fraction.increment};
    return solution;
  }
  const Rational most = increment_per_clock(Rational(axis.max_ab_hz), bits, fpga_hz);
  GRAVURE_TRY(solution.pair, best_ab_pair(solution.wanted_increment, bits, job.fpga.max_prescaler, most));
  solution.relative_error =
      Rational(Integer(solution.pair.increment), Integer(solution.pair.prescaler)) / solution.wanted_increment -
      Rational(1);
  return solution;
}

Result<std::vector<AbSolution>> solve_all(const Job& job, const Plan& plan, const std::vector<AxisRequest>& axes,
                                          std::int64_t slots) {
  std::vector<AbSolution> solutions;
  for (const AxisRequest& axis : axes) {
    GRAVURE_TRY(AbSolution solution, solve(job, plan, axis, slots));
    solutions.push_back(std::move(solution));
  }
  return solutions;
}

/// Micrometres by which the axis that drifts most is off after a revolution.
Rational worst_drift_um(const std::vector<AxisRequest>& axes, const std::vector<AbSolution>& solutions) {
  Rational worst = 0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    worst = std::max(worst, Rational(abs(solutions[i].relative_error) * axes[i].travel_um));
  }
  return worst;
}

}  // namespace

Rational linear_edges(const Rational& travel_um, const Rational& encoder_pitch_um, int interpolation_bits) {
  return travel_um / encoder_pitch_um * Rational(Integer(4) << static_cast<unsigned>(interpolation_bits));
}

AxisRequest cross_scan_axis(const Job& job, const Plan& plan) {
  const RotaryPlan& rotary = plan.rotary;
  if (job.mode == Mode::flat) {
    return {"stage",
            job.stage.interpolation_bits,
            job.stage.max_ab_hz,
            rotary.edges_per_revolution,
            rotary.circumference_um,
            job.stage.encoder_pitch_um,
            job.fpga.fractional};
  }
  return {"rotary",
          job.rotary.interpolation_bits,
          job.rotary.max_ab_hz,
          rotary.edges_per_revolution,
          rotary.circumference_um,
          ratio(job.rotary.gear_encoder_turns, job.rotary.gear_workpiece_turns),
          job.fpga.fractional};
}

AxisRequest carriage_axis(const Job& job, const Plan& plan) {
  const CarriagePlan& carriage = *plan.carriage;
  return {"carriage",       job.carriage.interpolation_bits, job.carriage.max_ab_hz, carriage.edges_per_revolution,
          carriage.feed_um, job.carriage.encoder_pitch_um};
}

Rational wanted_hz(const Plan& plan, const AxisRequest& axis, std::int64_t slots) {
  const Rational revolutions_per_second =
      plan.clock.pulse_hz / Rational(Integer(slots) * plan.rotary.lines_per_revolution);
  return revolutions_per_second * axis.edges_per_revolution / Rational(4);
}

void check_reach(const Job& job, const Plan& plan, const AxisRequest& axis, std::int64_t longest_line,
                 Violations& violations) {
  const Rational wanted = wanted_hz(plan, axis, longest_line);
  if (wanted > reachable_hz(axis, plan)) {
    violations.conflict(ErrorCode::out_of_range, axis.section + ".interpolation_bits",
                        std::to_string(axis.interpolation_bits),
                        "needs an A-B signal of " + number_text(wanted) + " Hz, above " + reach_limit(axis, plan) +
                            "; " + what_would_fit(job, plan, axis, longest_line));
  }
}

Result<std::vector<AbSolution>> choose_line(const Job& job, const std::vector<AxisRequest>& axes, Plan& plan,
                                            std::int64_t longest_line) {
  std::vector<AbSolution> best;
  std::optional<Error> refused;
  std::int64_t best_slots = 0;
  Rational least = 0;
  const auto reachable = [&](std::int64_t slots) {
    return std::all_of(axes.begin(), axes.end(), [&](const AxisRequest& axis) {
      return wanted_hz(plan, axis, slots) <= reachable_hz(axis, plan);
    });
  };
  for (std::int64_t slots = plan.line.slots; slots <= longest_line; slots += plan.line.slots_per_microvector) {
    if (!window_fits(plan.line, slots) || !reachable(slots)) {
      continue;
    }
    Result<std::vector<AbSolution>> solved = solve_all(job, plan, axes, slots);
    if (!solved) {  // another length may have a ratio that fits the registers
      refused = refused ? refused : solved.error();
      continue;
    }
    std::vector<AbSolution> solutions = std::move(solved).value();
    const Rational drift = worst_drift_um(axes, solutions);
    if (best.empty() || drift < least) {
      best = std::move(solutions);
      best_slots = slots;
      least = drift;
      if (least == 0) {
        break;
      }
    }
  }
  if (best.empty() && refused) {
    return *refused;
  }
  plan.line.slots = best_slots;
  return best;
}

AbPlan ab_plan(const Job& job, const Plan& plan, const AxisRequest& axis, const AbSolution& solution) {
  const Rational travel_per_line_um = axis.travel_um / Rational(plan.rotary.lines_per_revolution);
  AbPlan ab;
  ab.counter_bits = job.fpga.counter_bits;
  ab.prescaler = solution.pair.prescaler;
  ab.increment = solution.pair.increment;
  ab.fraction_num = solution.fraction.num;
  ab.fraction_den = solution.fraction.den;
  ab.wanted_increment = solution.wanted_increment;
  ab.wanted_hz = wanted_hz(plan, axis, plan.line.slots);
  ab.output_hz = ab.wanted_hz * (Rational(1) + solution.relative_error);
  ab.max_output_hz = axis.max_ab_hz;
  ab.exact = solution.relative_error == 0;
  ab.drift_lines_per_revolution = solution.relative_error * Rational(plan.rotary.lines_per_revolution);
  ab.drift_um_per_revolution = ab.drift_lines_per_revolution * travel_per_line_um;
  ab.seam_limit_um = job.limits.seam_um;
  const Rational limit_lines = ab.seam_limit_um / travel_per_line_um;
  const Integer lines_until_limit = ab.exact ? Integer(0) : ceil_of(limit_lines / abs(solution.relative_error));
  // A stage that keeps within the limit for a pass does so for ever: each pass starts where the one before ended.
  const bool reached = plan.mode != Mode::flat || lines_until_limit <= plan.rotary.lines_per_revolution;
  if (!ab.exact && reached) {
    ab.lines_until_limit = lines_until_limit;
    ab.revolutions_until_limit = ceil_of(Rational(*ab.lines_until_limit, Integer(plan.rotary.lines_per_revolution)));
  }
  ab.bound_lines_until_limit = floor_of(Rational(2) * Rational(ab.increment) * limit_lines);
  return ab;
}

}  // namespace gravure::sync_plan
