#include "gravure/sync/make_plan.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "check_job.hpp"
#include "gravure/sync/ab_ratio.hpp"
#include "line_window.hpp"
#include "plan_warnings.hpp"
#include "violations.hpp"

namespace gravure {

using namespace sync_plan;

namespace {

/// The counter's solution for one length of line.
struct AbSolution {
  AbPair pair;
  AbFraction fraction;
  Rational wanted_increment;
  Rational relative_error;  ///< (emitted / wanted) - 1
};

// --- clock, workpiece and line: each part checks what it needs and leaves the rest of the plan alone ---

void plan_clock(const Job& job, ClockPlan& clock, Violations& violations) {
  const LaserSettings& laser = job.laser;
  if (violations.sound({"laser.seed_hz", "fpga.clock_multiplier"})) {
    clock.seed_hz = laser.seed_hz;
    clock.fpga_hz = job.fpga.clock_multiplier * laser.seed_hz;
  }
  if (violations.sound({"laser.pulse_divider", "fpga.clock_multiplier"})) {
    clock.pulse_divider = laser.pulse_divider;
    clock.ticks_per_slot = job.fpga.clock_multiplier * laser.pulse_divider;
  }
  if (!violations.sound({"laser.seed_hz", "laser.pulse_divider"})) {
    return;
  }
  clock.pulse_hz = ratio(laser.seed_hz, laser.pulse_divider);
  if (violations.sound({"laser.max_pulse_on_demand_hz"}) && clock.pulse_hz > Rational(laser.max_pulse_on_demand_hz)) {
    violations.conflict(ErrorCode::out_of_range, "laser.pulse_divider", std::to_string(laser.pulse_divider),
                        "pulses at " + number_text(clock.pulse_hz) +
                            " Hz, faster than laser.max_pulse_on_demand_hz = " +
                            std::to_string(laser.max_pulse_on_demand_hz) + "; the smallest divider that fits is " +
                            to_string(ceil_of(ratio(laser.seed_hz, laser.max_pulse_on_demand_hz))));
  }
}

void plan_lines_per_revolution(const RotarySettings& settings, RotaryPlan& rotary, Violations& violations) {
  if (!violations.sound({"rotary.diameter_mm", "rotary.circumference_mm"})) {
    return;
  }
  rotary.circumference_um =
      (settings.circumference_mm ? *settings.circumference_mm : *settings.diameter_mm * pi()) * Rational(1000);
  if (!violations.sound({"rotary.line_pitch_um", "rotary.lines_per_revolution"})) {
    return;
  }
  if (settings.lines_per_revolution) {
    rotary.lines_per_revolution = *settings.lines_per_revolution;
  } else {
    const Integer lines = round_of(rotary.circumference_um / *settings.line_pitch_um);
    if (lines < 1 || lines > kMostCount) {
      violations.refuse(ErrorCode::out_of_range, "rotary.line_pitch_um", number_text(*settings.line_pitch_um),
                        "gives " + to_string(lines) + " lines on a circumference of " +
                            number_text(rotary.circumference_um) + " um; 1 to " + std::to_string(kMostCount) +
                            " lines fit, a pitch of " + number_text(rotary.circumference_um / Rational(kMostCount)) +
                            " to " + number_text(rotary.circumference_um) + " um");
      return;
    }
    rotary.lines_per_revolution = static_cast<std::int64_t>(lines);
  }
  rotary.line_pitch_um = rotary.circumference_um / Rational(rotary.lines_per_revolution);
}

void plan_axis(const RotarySettings& settings, RotaryPlan& rotary) {
  rotary.encoder_lines = settings.encoder_lines;
  rotary.interpolation_bits = settings.interpolation_bits;
  rotary.gear_encoder_turns = settings.gear_encoder_turns;
  rotary.gear_workpiece_turns = settings.gear_workpiece_turns;
  rotary.edges_per_revolution = ratio((Integer(4) << static_cast<unsigned>(settings.interpolation_bits)) *
                                          settings.encoder_lines * settings.gear_encoder_turns,
                                      settings.gear_workpiece_turns);
}

/// Ticks of line, revolution and job for the longest line in question. Refuses what does not fit 64 bits.
void check_ticks(const Job& job, const Plan& plan, std::int64_t longest_line, Violations& violations) {
  const Integer line = Integer(longest_line) * plan.clock.ticks_per_slot;
  const Integer revolution = line * plan.rotary.lines_per_revolution;
  const Integer whole = revolution * plan.job.revolutions;
  const Integer most = std::numeric_limits<std::int64_t>::max();
  if (line > most) {
    violations.refuse(ErrorCode::out_of_range, "image.pixels_per_line", std::to_string(plan.line.pixels),
                      "a line takes " + to_string(line) + " FPGA ticks, beyond 64-bit integers; at most " +
                          to_string(Integer(most / plan.clock.ticks_per_slot)) + " slots a line fit");
  } else if (revolution > most) {
    const bool given = job.rotary.lines_per_revolution.has_value();
    violations.refuse(ErrorCode::out_of_range, given ? "rotary.lines_per_revolution" : "rotary.line_pitch_um",
                      given ? std::to_string(*job.rotary.lines_per_revolution) : number_text(*job.rotary.line_pitch_um),
                      "a revolution takes " + to_string(revolution) + " FPGA ticks, beyond 64-bit integers; at most " +
                          to_string(Integer(most / line)) + " lines per revolution fit");
  } else if (whole > most) {
    violations.refuse(ErrorCode::out_of_range, "image.revolutions", std::to_string(plan.job.revolutions),
                      "the job takes " + to_string(whole) + " FPGA ticks, beyond 64-bit integers; at most " +
                          to_string(Integer(most / revolution)) + " revolutions fit");
  }
}

// --- the A-B signal ---

/// A-B periods per second the motion control wants for a line of `slots`, [B] eqs 3 to 5 with the gear.
Rational wanted_hz(const Plan& plan, std::int64_t slots) {
  const Rational revolutions_per_second =
      plan.clock.pulse_hz / Rational(Integer(slots) * plan.rotary.lines_per_revolution);
  return revolutions_per_second * plan.rotary.edges_per_revolution / Rational(4);
}

/// Highest A-B frequency: what the motion control takes, or one edge per FPGA clock ([B] eq. 2).
Rational reachable_hz(const Job& job, const Plan& plan) {
  return std::min(Rational(job.rotary.max_ab_hz), ratio(plan.clock.fpga_hz, 4));
}

std::string reach_limit(const Job& job, const Plan& plan) {
  if (Rational(job.rotary.max_ab_hz) <= ratio(plan.clock.fpga_hz, 4)) {
    return "rotary.max_ab_hz = " + std::to_string(job.rotary.max_ab_hz);
  }
  return "what the counter can emit, a quarter of the FPGA clock = " + number_text(ratio(plan.clock.fpga_hz, 4)) +
         " Hz (increment <= 2^(n-2))";
}

/// What would bring the wanted frequency down to what can be emitted, each alone.
std::string what_would_fit(const Job& job, const Plan& plan, std::int64_t slots) {
  const Rational excess = wanted_hz(plan, slots) / reachable_hz(job, plan);
  std::string text;
  int bits = job.rotary.interpolation_bits;
  for (Rational left = excess; left > 1 && bits >= 0; left /= 2) {
    --bits;
  }
  if (bits >= 0) {
    text += "rotary.interpolation_bits <= " + std::to_string(bits) + ", ";
  }
  const Integer least_slots =
      ceil_of(excess * Rational(slots) / Rational(plan.line.slots_per_microvector)) * plan.line.slots_per_microvector;
  text += "a rotary.gear ratio of at most " +
          number_text(ratio(job.rotary.gear_encoder_turns, job.rotary.gear_workpiece_turns) / excess);
  if (least_slots - plan.line.pixels <= kMostTurnSlots) {
    text += ", lines of at least " + to_string(least_slots) +
            " slots (scanner.turn_slots >= " + to_string(Integer(least_slots - plan.line.pixels)) + ")";
  }
  text += " or laser.pulse_divider >= " + to_string(ceil_of(excess * Rational(job.laser.pulse_divider))) + " would fit";
  return text;
}

void check_reach(const Job& job, const Plan& plan, std::int64_t longest_line, Violations& violations) {
  const Rational wanted = wanted_hz(plan, longest_line);
  if (wanted > reachable_hz(job, plan)) {
    violations.conflict(ErrorCode::out_of_range, "rotary.interpolation_bits",
                        std::to_string(job.rotary.interpolation_bits),
                        "needs an A-B signal of " + number_text(wanted) + " Hz, above " + reach_limit(job, plan) +
                            "; " + what_would_fit(job, plan, longest_line));
  }
}

Result<AbSolution> solve_ab(const Job& job, const Plan& plan, std::int64_t slots) {
  const int bits = job.fpga.counter_bits;
  const Rational fpga_hz = plan.clock.fpga_hz;
  AbSolution solution;
  solution.wanted_increment = increment_per_clock(wanted_hz(plan, slots), bits, fpga_hz);
  if (job.fpga.fractional) {
    GRAVURE_TRY(solution.fraction, exact_fraction(solution.wanted_increment, bits));
    solution.pair = {.prescaler = 1, .increment = solution.fraction.increment};
    return solution;
  }
  const Rational most = increment_per_clock(Rational(job.rotary.max_ab_hz), bits, fpga_hz);
  GRAVURE_TRY(solution.pair, best_ab_pair(solution.wanted_increment, bits, job.fpga.max_prescaler, most));
  solution.relative_error =
      Rational(Integer(solution.pair.increment), Integer(solution.pair.prescaler)) / solution.wanted_increment -
      Rational(1);
  return solution;
}

/// The length of line with the smallest drift, and its solution. Only lengths that hold the marking window and whose
/// frequency is within reach count; the longest does.
Result<AbSolution> choose_line(const Job& job, Plan& plan, std::int64_t longest_line) {
  std::optional<AbSolution> best;
  std::int64_t best_slots = 0;
  const Rational most_hz = reachable_hz(job, plan);
  for (std::int64_t slots = plan.line.slots; slots <= longest_line; slots += plan.line.slots_per_microvector) {
    if (!window_fits(plan.line, slots) || wanted_hz(plan, slots) > most_hz) {
      continue;
    }
    GRAVURE_TRY(AbSolution solution, solve_ab(job, plan, slots));
    if (!best || abs(solution.relative_error) < abs(best->relative_error)) {
      best = std::move(solution);
      best_slots = slots;
      if (best->relative_error == 0) {
        break;
      }
    }
  }
  plan.line.slots = best_slots;
  return std::move(*best);
}

void fill_ab(const Job& job, const AbSolution& solution, Plan& plan) {
  AbPlan& ab = plan.ab;
  ab.counter_bits = job.fpga.counter_bits;
  ab.prescaler = solution.pair.prescaler;
  ab.increment = solution.pair.increment;
  ab.fraction_num = solution.fraction.num;
  ab.fraction_den = solution.fraction.den;
  ab.wanted_increment = solution.wanted_increment;
  ab.wanted_hz = wanted_hz(plan, plan.line.slots);
  ab.output_hz = ab.wanted_hz * (Rational(1) + solution.relative_error);
  ab.max_output_hz = job.rotary.max_ab_hz;
  ab.exact = solution.relative_error == 0;
  ab.drift_lines_per_revolution = solution.relative_error * Rational(plan.rotary.lines_per_revolution);
  ab.drift_um_per_revolution = ab.drift_lines_per_revolution * plan.rotary.line_pitch_um;
  ab.seam_limit_um = job.limits.seam_um;
  const Rational limit_lines = ab.seam_limit_um / plan.rotary.line_pitch_um;
  if (!ab.exact) {
    ab.lines_until_limit = ceil_of(limit_lines / abs(solution.relative_error));
    ab.revolutions_until_limit = ceil_of(Rational(*ab.lines_until_limit, Integer(plan.rotary.lines_per_revolution)));
  }
  ab.bound_lines_until_limit = floor_of(Rational(2) * Rational(ab.increment) * limit_lines);
}

/// Everything that follows from the length of the line.
void fill_times(Plan& plan) {
  LinePlan& line = plan.line;
  RotaryPlan& rotary = plan.rotary;
  place_window(line);
  line.ticks = line.slots * plan.clock.ticks_per_slot;
  line.rate_hz = plan.clock.pulse_hz / Rational(line.slots);
  line.scan_speed_m_s = line.pixel_pitch_um * plan.clock.pulse_hz / Rational(1'000'000);
  rotary.ticks_per_revolution = line.ticks * rotary.lines_per_revolution;
  const Rational revolutions_per_second = line.rate_hz / Rational(rotary.lines_per_revolution);
  rotary.rpm = revolutions_per_second * Rational(60);
  rotary.surface_speed_mm_s = revolutions_per_second * rotary.circumference_um / Rational(1000);
  plan.job.ticks = rotary.ticks_per_revolution * plan.job.revolutions;
  plan.job.duration_s = ratio(plan.job.ticks, plan.clock.fpga_hz);
}

/// The shortest line and the axis, as far as their values are in order, and every check on them. Returns the slots of
/// the longest line.
std::int64_t check_line(const Job& job, std::int64_t pixels_per_line, Plan& plan, Violations& violations) {
  if (!violations.sound({"laser.pulse_divider", "fpga.clock_multiplier", "scanner.slots_per_microvector",
                         "scanner.turn_slots", "scanner.max_extra_slots", "image.pixels_per_line"})) {
    return 0;
  }
  plan_line(job.scanner, pixels_per_line, plan.clock.ticks_per_slot, plan.line);
  const std::int64_t longest_line = longest_line_slots(job.scanner, plan.line);
  check_window(job.scanner, plan.line, longest_line, plan.clock.ticks_per_slot, violations);
  if (!violations.sound({"laser.seed_hz", "rotary.diameter_mm", "rotary.circumference_mm", "rotary.line_pitch_um",
                         "rotary.lines_per_revolution"})) {
    return longest_line;
  }
  if (violations.sound({"image.revolutions"})) {
    check_ticks(job, plan, longest_line, violations);
  }
  if (violations.sound({"rotary.encoder_lines", "rotary.interpolation_bits", "rotary.gear", "rotary.max_ab_hz"})) {
    plan_axis(job.rotary, plan.rotary);
    check_reach(job, plan, longest_line, violations);
  }
  return longest_line;
}

}  // namespace

Result<Plan> make_plan(const Job& job, std::int64_t pixels_per_line, std::int64_t revolutions) {
  Violations violations(job);
  check_fields(job, pixels_per_line, revolutions, violations);
  Plan plan;
  plan.title = job.title;
  plan.mode = job.mode;
  plan.job.revolutions = revolutions;
  plan_clock(job, plan.clock, violations);
  plan_lines_per_revolution(job.rotary, plan.rotary, violations);
  const std::int64_t longest_line = check_line(job, pixels_per_line, plan, violations);
  if (!violations.none()) {
    return violations.error();
  }
  GRAVURE_TRY(const AbSolution solution, choose_line(job, plan, longest_line));
  fill_times(plan);
  fill_ab(job, solution, plan);
  plan.warnings = plan_warnings(job, plan);
  return plan;
}

}  // namespace gravure
