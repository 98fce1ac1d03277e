#include "gravure/pipeline/path_plan.hpp"

#include <limits>

namespace gravure {
namespace {

Error refuse(ErrorCode code, const std::string& message) {
  return {code, message};
}

Result<void> check_request(const PathPlanRequest& request, std::int64_t instants, std::int64_t pulses,
                           std::int64_t targets) {
  if (!follows_path(request.mode)) {
    return refuse(ErrorCode::bad_argument,
                  "mode " + std::string(mode_name(request.mode)) + ": only freeform and zones follow a path");
  }
  const LaserSettings& laser = request.laser;
  if (laser.seed_hz < 1 || laser.pulse_divider < 1 || request.clock_multiplier < 1 || request.clock_multiplier > 16 ||
      laser.pulse_divider > 65'535 || laser.seed_hz > 1'000'000'000'000) {
    return refuse(ErrorCode::out_of_range, "laser.seed_hz = " + std::to_string(laser.seed_hz) +
                                               ", laser.pulse_divider = " + std::to_string(laser.pulse_divider) +
                                               ", fpga.clock_multiplier = " + std::to_string(request.clock_multiplier) +
                                               ": must be 1 to 10^12, 1 to 65535, 1 to 16");
  }
  if (request.pulse_pitch_um <= 0) {
    return refuse(ErrorCode::out_of_range,
                  "pulse pitch = " + to_decimal_string(request.pulse_pitch_um) + " um: must be greater than 0");
  }
  if (instants < 2) {
    return refuse(ErrorCode::bad_argument,
                  "the motion has " + std::to_string(instants) + " instants: at least 2 are a servo period");
  }
  if (pulses < 0 || targets < 0 || targets == 1) {
    return refuse(ErrorCode::bad_argument, "a path has " + std::to_string(pulses) + " pulses and " +
                                               std::to_string(targets) +
                                               " wanted points: must be 0 or more, and none or at least 2");
  }
  const Rational pulse_hz = ratio(laser.seed_hz, laser.pulse_divider);
  if (laser.max_pulse_on_demand_hz > 0 && pulse_hz > Rational(laser.max_pulse_on_demand_hz)) {
    return refuse(ErrorCode::out_of_range, "laser.pulse_divider = " + std::to_string(laser.pulse_divider) +
                                               ": pulses at " + to_decimal_string(pulse_hz) +
                                               " Hz, the gate switches at most " +
                                               std::to_string(laser.max_pulse_on_demand_hz) + " Hz");
  }
  return {};
}

/// Pulse slots of a servo period.
Result<std::int64_t> slots_of(const PathPlanRequest& request) {
  const Rational slot_us = Rational(1'000'000) * ratio(request.laser.pulse_divider, request.laser.seed_hz);
  const Rational slots = request.servo_period_us / slot_us;
  if (slots < 1 || slots > Rational(kMostSlotsPerLine)) {
    return refuse(ErrorCode::out_of_range, "servo_us = " + to_decimal_string(request.servo_period_us) +
                                               ": must be 1 to " + std::to_string(kMostSlotsPerLine) +
                                               " pulse slots of " + to_decimal_string(slot_us) + " us");
  }
  if (denominator_of(slots) != 1) {
    return refuse(ErrorCode::bad_argument,
                  "servo_us = " + to_decimal_string(request.servo_period_us) +
                      ": must be a whole number of pulse slots of " + to_decimal_string(slot_us) +
                      " us: " + to_decimal_string(Rational(floor_of(slots)) * slot_us) + " or " +
                      to_decimal_string(Rational(ceil_of(slots)) * slot_us) + " would be");
  }
  return to_int64(numerator_of(slots), "servo_us");
}

LinePlan line_of(const ClockPlan& clock, std::int64_t slots, const Rational& pitch_um) {
  LinePlan line;
  line.pixels = slots;
  line.slots = slots;
  line.ticks = slots * clock.ticks_per_slot;
  line.bidirectional = false;
  line.rate_hz = clock.pulse_hz / Rational(slots);
  line.pixel_pitch_um = pitch_um;
  line.scan_speed_m_s = pitch_um * clock.pulse_hz / Rational(1'000'000);
  return line;
}

}  // namespace

Result<Plan> make_path_plan(const PathPlanRequest& request, std::int64_t instants, std::int64_t pulses,
                            std::int64_t targets) {
  GRAVURE_CHECK(check_request(request, instants, pulses, targets));
  GRAVURE_TRY(const std::int64_t slots, slots_of(request));
  Plan plan;
  plan.title = request.title;
  plan.mode = request.mode;
  const LaserSettings& laser = request.laser;
  plan.clock = {laser.seed_hz, request.clock_multiplier * laser.seed_hz, laser.pulse_divider,
                ratio(laser.seed_hz, laser.pulse_divider), request.clock_multiplier * laser.pulse_divider};
  plan.line = line_of(plan.clock, slots, request.pulse_pitch_um);
  plan.rotary.lines_per_revolution = instants - 1;
  GRAVURE_TRY(plan.rotary.ticks_per_revolution,
              to_int64(Integer(plan.line.ticks) * (instants - 1), "ticks of the path"));
  plan.job = {1, plan.rotary.ticks_per_revolution, ratio(plan.rotary.ticks_per_revolution, plan.clock.fpga_hz)};
  PathPlan path = request.path;
  for (PathAxisPlan& axis : path.axes) {
    axis.counts_per_unit = axis.counts_per_unit == 0 ? Rational(kPathCounts) : axis.counts_per_unit;
  }
  path.along_counts_per_mm = path.along_counts_per_mm == 0 ? Rational(kAlongCounts) : path.along_counts_per_mm;
  path.machine = path.machine.empty() ? "texturing" : path.machine;
  path.pulses = pulses;
  path.targets = targets;
  plan.path = std::move(path);
  return plan;
}

}  // namespace gravure
