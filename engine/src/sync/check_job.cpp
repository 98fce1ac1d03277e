#include "check_job.hpp"

#include <limits>
#include <string>

#include "gravure/core/line_device.hpp"
#include "gravure/core/plan.hpp"

namespace gravure::sync_plan {
namespace {

constexpr std::int64_t kMostHz = 1'000'000'000'000;
constexpr std::int64_t kMostMillimetres = 1'000'000;
constexpr std::int64_t kMostMicrometres = 1'000'000'000;
constexpr int kLeastCounterBits = 8;
constexpr int kMostCounterBits = 64;
constexpr int kMostInterpolationBits = 32;
constexpr int kLeastScannerBits = 8;
constexpr int kMostScannerBits = 26;
constexpr int kMostOffsetDeg = 85;
constexpr int kMostTiltDegPerMm = 10;

void check_clocks(const Job& job, Violations& violations) {
  violations.check_range("laser.seed_hz", job.laser.seed_hz, 1, kMostHz);
  violations.check_range("laser.pulse_divider", job.laser.pulse_divider, 1, kMostSeedsPerSlot);
  violations.check_range("laser.max_pulse_on_demand_hz", job.laser.max_pulse_on_demand_hz, 1, kMostHz);
  violations.check_range("fpga.clock_multiplier", job.fpga.clock_multiplier, 1, kMostClockMultiplier);
  violations.check_range("fpga.counter_bits", job.fpga.counter_bits, kLeastCounterBits, kMostCounterBits);
  violations.check_range("fpga.max_prescaler", job.fpga.max_prescaler, 1, std::numeric_limits<std::uint64_t>::max());
}

void check_scanner(const ScannerSettings& scanner, Violations& violations) {
  violations.check_positive("scanner.pixel_pitch_um", scanner.pixel_pitch_um, kMostMicrometres);
  violations.check_range("scanner.slots_per_microvector", scanner.slots_per_microvector, 1, kMostCount);
  violations.check_range("scanner.turn_slots", scanner.turn_slots, 0, kMostTurnSlots);
  violations.check_range("scanner.max_extra_slots", scanner.max_extra_slots, 0, kMostExtraSlots);
  if (scanner.field_mm) {
    violations.check_positive("scanner.field_mm", *scanner.field_mm, kMostMillimetres);
  }
  violations.check_range("scanner.resolution_bits", scanner.resolution_bits, kLeastScannerBits, kMostScannerBits);
  violations.check_range("scanner.lag_us", scanner.lag_us, 0, kMostMillimetres);
  violations.check_range("scanner.offset_deg", scanner.offset_deg, -kMostOffsetDeg, kMostOffsetDeg);
  violations.check_range("scanner.tilt_deg_per_mm", scanner.tilt_deg_per_mm, 0, kMostTiltDegPerMm);
  const auto limit = [&violations](std::string_view key, const std::optional<Rational>& value, const Rational& most) {
    if (value) {
      violations.check_positive(key, *value, most);
    }
  };
  limit("scanner.max_speed_mm_s", scanner.max_speed_mm_s, Rational(Integer(1'000'000'000)));
  limit("scanner.max_acceleration_mm_s2", scanner.max_acceleration_mm_s2, Rational(Integer(1'000'000'000'000)));
  limit("scanner.max_jerk_mm_s3", scanner.max_jerk_mm_s3, Rational(Integer(1'000'000'000'000'000'000)));
}

/// What one setting of the scanner may be depends on more than itself.
void check_scanner_together(const Job& job, Violations& violations) {
  if (job.mode == Mode::flat && job.scanner.offset_deg != 0) {
    violations.conflict(ErrorCode::bad_argument, "scanner.offset_deg", number_text(job.scanner.offset_deg),
                        "lines of a flat job lie on no circumference; take the key out");
  }
  if (job.scanner.field_grid_text.size() > kMostPlanGridBytes) {
    violations.conflict(ErrorCode::out_of_range, "scanner.field_grid",
                        job.scanner.field_grid ? "\"" + *job.scanner.field_grid + "\"" : "(text)",
                        "the grid takes " + std::to_string(job.scanner.field_grid_text.size()) +
                            " bytes; a program carries at most " + std::to_string(kMostPlanGridBytes) +
                            ": fewer nodes will do");
  }
}

/// Exactly one of two keys; says which, if not.
void check_one_of(std::string_view first, bool has_first, std::string_view second, bool has_second,
                  Violations& violations) {
  if (has_first && has_second) {
    violations.refuse_missing(
        first, "and " + std::string(second) + " are both given: they fix the same thing twice; " + "keep one of them");
  }
  if (!has_first && !has_second) {
    violations.refuse_missing(first,
                              "and " + std::string(second) + " are both missing: exactly one of them must be given");
  }
}

void check_workpiece(const RotarySettings& rotary, Violations& violations) {
  check_one_of("rotary.diameter_mm", rotary.diameter_mm.has_value(), "rotary.circumference_mm",
               rotary.circumference_mm.has_value(), violations);
  check_one_of("rotary.line_pitch_um", rotary.line_pitch_um.has_value(), "rotary.lines_per_revolution",
               rotary.lines_per_revolution.has_value(), violations);
  if (rotary.diameter_mm) {
    violations.check_positive("rotary.diameter_mm", *rotary.diameter_mm, kMostMillimetres);
  }
  if (rotary.circumference_mm) {
    violations.check_positive("rotary.circumference_mm", *rotary.circumference_mm, kMostMillimetres);
  }
  if (rotary.line_pitch_um) {
    violations.check_positive("rotary.line_pitch_um", *rotary.line_pitch_um, kMostMicrometres);
  }
  if (rotary.lines_per_revolution) {
    violations.check_range("rotary.lines_per_revolution", *rotary.lines_per_revolution, 1, kMostCount);
  }
}

void check_linear_axis(const std::string& section, const Rational& encoder_pitch_um, int interpolation_bits,
                       std::int64_t max_ab_hz, Violations& violations) {
  violations.check_positive(section + ".encoder_pitch_um", encoder_pitch_um, kMostMicrometres);
  violations.check_range(section + ".interpolation_bits", interpolation_bits, 0, kMostInterpolationBits);
  violations.check_range(section + ".max_ab_hz", max_ab_hz, 1, kMostHz);
}

void check_carriage(const CarriageSettings& carriage, Violations& violations) {
  violations.check_positive("carriage.feed_pixels", carriage.feed_pixels, kMostCount);
  violations.check_range("carriage.layers", carriage.layers, 1, kMostRevolutions / 2);
  check_linear_axis("carriage", carriage.encoder_pitch_um, carriage.interpolation_bits, carriage.max_ab_hz, violations);
}

void check_stage(const StageSettings& stage, Violations& violations) {
  violations.check_range("stage.lines", stage.lines, 1, kMostCount);
  violations.check_positive("stage.line_pitch_um", stage.line_pitch_um, kMostMicrometres);
  check_linear_axis("stage", stage.encoder_pitch_um, stage.interpolation_bits, stage.max_ab_hz, violations);
}

void check_axis(const RotarySettings& rotary, Violations& violations) {
  violations.check_range("rotary.encoder_lines", rotary.encoder_lines, 1, kMostCount);
  violations.check_range("rotary.interpolation_bits", rotary.interpolation_bits, 0, kMostInterpolationBits);
  violations.check_range("rotary.max_ab_hz", rotary.max_ab_hz, 1, kMostHz);
  const auto gear_side = [](std::int64_t turns) { return turns >= 1 && turns <= kMostGearTurns; };
  if (!gear_side(rotary.gear_encoder_turns) || !gear_side(rotary.gear_workpiece_turns)) {
    std::string value = std::to_string(rotary.gear_encoder_turns);
    value.insert(value.begin(), '[');
    value += ", " + std::to_string(rotary.gear_workpiece_turns) + "]";
    violations.refuse(ErrorCode::out_of_range, "rotary.gear", value,
                      "both must be 1 to " + std::to_string(kMostGearTurns) + ", encoder turns : workpiece turns");
  }
}

}  // namespace

void check_fields(const Job& job, std::int64_t columns, std::int64_t exposures, Violations& violations) {
  check_clocks(job, violations);
  check_scanner(job.scanner, violations);
  check_scanner_together(job, violations);
  if (job.mode == Mode::flat) {
    check_stage(job.stage, violations);
  } else {
    check_workpiece(job.rotary, violations);
    check_axis(job.rotary, violations);
  }
  if (job.mode == Mode::helical) {
    check_carriage(job.carriage, violations);
  }
  violations.check_range("image.pixels_per_line", columns, 1, kMostCount);
  violations.check_range("image.revolutions", exposures, 1, std::numeric_limits<std::int64_t>::max());
  violations.check_positive("limits.seam_um", job.limits.seam_um, kMostMicrometres);
}

}  // namespace gravure::sync_plan
