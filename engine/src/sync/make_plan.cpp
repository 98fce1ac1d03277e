#include "gravure/sync/make_plan.hpp"

#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "check_job.hpp"
#include "line_window.hpp"
#include "plan_axis.hpp"
#include "plan_exposures.hpp"
#include "plan_spins.hpp"
#include "plan_warnings.hpp"
#include "violations.hpp"

namespace gravure {

using namespace sync_plan;

namespace {

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

void plan_rotary_axis(const RotarySettings& settings, RotaryPlan& rotary, const Violations& violations) {
  if (!violations.sound({"rotary.encoder_lines", "rotary.interpolation_bits", "rotary.gear"})) {
    return;
  }
  rotary.encoder_lines = settings.encoder_lines;
  rotary.interpolation_bits = settings.interpolation_bits;
  rotary.gear_encoder_turns = settings.gear_encoder_turns;
  rotary.gear_workpiece_turns = settings.gear_workpiece_turns;
  rotary.edges_per_revolution = ratio((Integer(4) << static_cast<unsigned>(settings.interpolation_bits)) *
                                          settings.encoder_lines * settings.gear_encoder_turns,
                                      settings.gear_workpiece_turns);
}

/// An axis outside the workpiece turns nothing.
void check_run_out(const Job& job, const RotaryPlan& rotary, Violations& violations) {
  const TwinSettings::RunOut& run_out = job.twin.run_out;
  const Rational radius_um = rotary.circumference_um / (2 * pi());
  if (job.mode != Mode::flat && run_out.enabled && radius_um > 0 && run_out.eccentricity_um >= radius_um) {
    violations.conflict(ErrorCode::out_of_range, "twin.run_out.eccentricity_um", number_text(run_out.eccentricity_um),
                        "must be less than the radius of the workpiece, " + number_text(radius_um) + " um");
  }
}

/// A pass of the stage stands for a revolution.
void plan_stage(const StageSettings& settings, RotaryPlan& rotary, const Violations& violations) {
  if (!violations.sound({"stage.lines", "stage.line_pitch_um"})) {
    return;
  }
  rotary.lines_per_revolution = settings.lines;
  rotary.line_pitch_um = settings.line_pitch_um;
  rotary.circumference_um = settings.line_pitch_um * Rational(settings.lines);
  if (violations.sound({"stage.encoder_pitch_um", "stage.interpolation_bits"})) {
    rotary.encoder_pitch_um = settings.encoder_pitch_um;
    rotary.interpolation_bits = settings.interpolation_bits;
    rotary.edges_per_revolution =
        linear_edges(rotary.circumference_um, settings.encoder_pitch_um, settings.interpolation_bits);
  }
}

/// What the job says of the scanner, once it says how large the field is.
std::optional<ScannerPlan> plan_scanner(const ScannerSettings& scanner) {
  if (!scanner.field_mm) {
    return std::nullopt;
  }
  return ScannerPlan{*scanner.field_mm,       scanner.resolution_bits,       scanner.lag_us,
                     scanner.compensate_lag,  scanner.max_speed_mm_s,        scanner.max_acceleration_mm_s2,
                     scanner.max_jerk_mm_s3,  scanner.cross_scan_correction, scanner.offset_deg,
                     scanner.tilt_deg_per_mm, scanner.field_grid_text};
}

/// The key that says how many lines a revolution has, and its value.
std::pair<std::string_view, std::string> lines_key(const Job& job) {
  if (job.mode == Mode::flat) {
    return {"stage.lines", std::to_string(job.stage.lines)};
  }
  if (job.rotary.lines_per_revolution) {
    return {"rotary.lines_per_revolution", std::to_string(*job.rotary.lines_per_revolution)};
  }
  return {"rotary.line_pitch_um", number_text(*job.rotary.line_pitch_um)};
}

/// Ticks of revolution and job for the longest line in question. Refuses what does not fit 64 bits; a line always does.
void check_ticks(const Job& job, const Plan& plan, std::int64_t longest_line, Violations& violations) {
  const Integer line = Integer(longest_line) * plan.clock.ticks_per_slot;
  const Integer revolution = line * plan.rotary.lines_per_revolution;
  const Integer whole = revolution * plan.job.revolutions;
  const Integer most = std::numeric_limits<std::int64_t>::max();
  if (revolution > most) {
    const auto [key, value] = lines_key(job);
    const std::string turn = job.mode == Mode::flat ? "pass" : "revolution";
    violations.refuse(ErrorCode::out_of_range, key, value,
                      "a " + turn + " takes " + to_string(revolution) +
                          " FPGA ticks, beyond 64-bit integers; at most " + to_string(Integer(most / line)) +
                          " lines per " + turn + " fit");
  } else if (whole > most) {
    violations.refuse(ErrorCode::out_of_range, plan.carriage ? "carriage.feed_pixels" : "image.revolutions",
                      plan.carriage ? number_text(plan.carriage->feed_pixels) : std::to_string(plan.job.revolutions),
                      "the job takes " + to_string(whole) + " FPGA ticks, beyond 64-bit integers; at most " +
                          to_string(Integer(most / revolution)) + " revolutions fit");
  }
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
  rotary.rpm = plan.mode == Mode::flat ? Rational(0) : revolutions_per_second * Rational(60);
  rotary.surface_speed_mm_s = revolutions_per_second * rotary.circumference_um / Rational(1000);
  if (plan.carriage) {
    plan.carriage->speed_mm_s = revolutions_per_second * plan.carriage->feed_um / Rational(1000);
  }
  plan.job.ticks = rotary.ticks_per_revolution * plan.job.revolutions;
  plan.job.duration_s = ratio(plan.job.ticks, plan.clock.fpga_hz);
}

/// What the lines of a revolution depend on: refused, nothing that counts lines can be judged.
bool lines_are_sound(const Violations& violations) {
  return violations.sound({"rotary.diameter_mm", "rotary.circumference_mm", "rotary.line_pitch_um",
                           "rotary.lines_per_revolution", "stage.lines", "stage.line_pitch_um"});
}

/// The shortest line and the axes, as far as their values are in order, and every check on them. Returns the slots of
/// the longest line; `axes` holds those that can be solved for.
std::int64_t check_line(const Job& job, std::int64_t pixels_per_line, Plan& plan, std::vector<AxisRequest>& axes,
                        Violations& violations) {
  if (!violations.sound({"laser.pulse_divider", "fpga.clock_multiplier", "scanner.slots_per_microvector",
                         "scanner.turn_slots", "scanner.max_extra_slots", "image.pixels_per_line"}) ||
      pixels_per_line < 1) {
    return 0;
  }
  plan_line(job.scanner, pixels_per_line, plan.clock.ticks_per_slot, plan.line);
  const std::int64_t longest_line = longest_line_slots(job.scanner, plan.line);
  if (longest_line > kMostSlotsPerLine) {
    violations.refuse(ErrorCode::out_of_range, plan.carriage ? "carriage.feed_pixels" : "image.pixels_per_line",
                      plan.carriage ? number_text(plan.carriage->feed_pixels) : std::to_string(plan.line.pixels),
                      "a line takes " + std::to_string(longest_line) +
                          " slots with turn_slots and max_extra_slots; the "
                          "board counts " +
                          std::to_string(kMostSlotsPerLine) + " at most: cut the picture into bands");
  }
  check_window(job, plan.line, longest_line, plan.clock.ticks_per_slot, violations);
  if (!violations.sound({"laser.seed_hz"}) || !lines_are_sound(violations)) {
    return longest_line;
  }
  if (violations.sound({"image.revolutions"})) {
    check_ticks(job, plan, longest_line, violations);
  }
  if (violations.sound({"rotary.encoder_lines", "rotary.interpolation_bits", "rotary.gear", "rotary.max_ab_hz",
                        "stage.encoder_pitch_um", "stage.interpolation_bits", "stage.max_ab_hz"})) {
    axes.push_back(cross_scan_axis(job, plan));
    check_reach(job, plan, axes.back(), longest_line, violations);
  }
  if (plan.carriage && violations.sound({"carriage.max_ab_hz"})) {
    axes.push_back(carriage_axis(job, plan));
    check_reach(job, plan, axes.back(), longest_line, violations);
  }
  return longest_line;
}

}  // namespace

Result<Plan> make_plan(const Job& job, std::int64_t columns, std::int64_t exposures) {
  Violations violations(job);
  check_fields(job, columns, exposures, violations);
  Plan plan;
  plan.title = job.title;
  plan.mode = job.mode;
  plan_clock(job, plan.clock, violations);
  if (job.mode == Mode::flat) {
    plan_stage(job.stage, plan.rotary, violations);
  } else {
    plan_lines_per_revolution(job.rotary, plan.rotary, violations);
    plan_rotary_axis(job.rotary, plan.rotary, violations);
  }
  check_run_out(job, plan.rotary, violations);
  std::vector<AxisRequest> axes;
  std::int64_t longest_line = 0;
  if (job.mode != Mode::helical || lines_are_sound(violations)) {
    const std::int64_t pixels = plan_exposures(job, columns, exposures, plan, violations);
    longest_line = check_line(job, pixels, plan, axes, violations);
  }
  if (!violations.none()) {
    return violations.error();
  }
  GRAVURE_TRY(const std::vector<AbSolution> solutions, choose_line(job, axes, plan, longest_line));
  fill_times(plan);
  plan.ab = ab_plan(job, plan, axes.front(), solutions.front());
  if (plan.carriage) {
    plan.carriage->ab = ab_plan(job, plan, axes.back(), solutions.back());
  }
  plan.scanner = plan_scanner(job.scanner);
  GRAVURE_CHECK(plan_spins(job, plan, violations));
  if (!violations.none()) {
    return violations.error();
  }
  plan.warnings = plan_warnings(job, plan);
  return plan;
}

}  // namespace gravure
