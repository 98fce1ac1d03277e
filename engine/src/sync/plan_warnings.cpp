#include "plan_warnings.hpp"

#include "check_job.hpp"
#include "text.hpp"

namespace gravure::sync_plan {
namespace {

/// `revolutions` are those over which the drift adds up.
void warn_drift(const AbPlan& ab, const char* axis, std::int64_t revolutions, const char* remedy,
                std::vector<std::string>& warnings) {
  const Rational drift_um = ab.drift_um_per_revolution * Rational(revolutions);
  if (abs(drift_um) <= ab.seam_limit_um) {
    return;
  }
  warnings.push_back(
      "after " + std::to_string(revolutions) + " revolutions the " + axis + " " + (drift_um > 0 ? "leads" : "lags") +
      " by " + number_text(abs(drift_um)) + " um, more than limits.seam_um = " + number_text(ab.seam_limit_um) +
      "; reached after " + to_string(*ab.lines_until_limit) + " lines, in revolution " +
      to_string(*ab.revolutions_until_limit) +
      " of the job counted from 1; scanner.max_extra_slots lets the planner look for a better line, " + remedy);
}

void warn_pitch(const Job& job, const Plan& plan, std::vector<std::string>& warnings) {
  if (plan.mode == Mode::flat || !job.rotary.line_pitch_um) {
    return;
  }
  const Rational& wanted = *job.rotary.line_pitch_um;
  const Rational change_percent = abs(plan.rotary.line_pitch_um - wanted) / wanted * Rational(100);
  if (change_percent > Rational(1, 10)) {
    warnings.push_back("rotary.line_pitch_um = " + number_text(wanted) + " becomes " +
                       number_text(plan.rotary.line_pitch_um) + " um (" + number_text(change_percent) +
                       " % off): a revolution holds whole lines, " + std::to_string(plan.rotary.lines_per_revolution) +
                       " of them");
  }
}

void warn_directions(const Job& job, const Plan& plan, std::vector<std::string>& warnings) {
  if (plan.mode != Mode::flat && plan.line.bidirectional && plan.rotary.lines_per_revolution % 2 != 0) {
    warnings.push_back("lines per revolution = " + std::to_string(plan.rotary.lines_per_revolution) +
                       " is odd and the scanner marks both ways: the same line of the next revolution runs the other "
                       "way (harmless; an even number keeps its direction)");
  }
  if (!plan.line.bidirectional && job.scanner.bidirectional_offset_ticks != 0) {
    warnings.push_back(
        "scanner.bidirectional_offset_ticks = " + std::to_string(job.scanner.bidirectional_offset_ticks) +
        " has no effect: scanner.bidirectional = false, so no line runs right to left");
  }
}

void warn_start(const Job& job, const Plan& plan, std::vector<std::string>& warnings) {
  if (plan.mode != Mode::flat && job.rotary.start_angle_deg != 0 && !plan.spin) {
    warnings.push_back("rotary.start_angle_deg = " + number_text(job.rotary.start_angle_deg) +
                       " has no effect: only an axis that is spun up from the encoder index has a start angle; give "
                       "rotary.max_speed_deg_s, max_acceleration_deg_s2 and max_jerk_deg_s3");
  }
}

void warn_encoder(const Plan& plan, std::vector<std::string>& warnings) {
  const RotaryPlan& rotary = plan.rotary;
  if (rotary.edges_per_revolution < Rational(rotary.lines_per_revolution)) {
    const std::string encoder =
        plan.mode == Mode::flat
            ? "stage.encoder_pitch_um = " + number_text(rotary.encoder_pitch_um) + " with stage.interpolation_bits = "
            : "rotary.encoder_lines = " + std::to_string(rotary.encoder_lines) + " with rotary.interpolation_bits = ";
    warnings.push_back(
        "the axis moves in steps of " + number_text(rotary.circumference_um / rotary.edges_per_revolution) +
        " um (one A-B edge), more than the line pitch of " + number_text(rotary.line_pitch_um) + " um: " + encoder +
        std::to_string(rotary.interpolation_bits) + " is too coarse to place single lines");
  }
}

void warn_carriage(const Plan& plan, std::vector<std::string>& warnings) {
  const CarriagePlan& carriage = *plan.carriage;
  warn_drift(carriage.ab, "carriage", plan.job.revolutions, "and so does another carriage.feed_pixels", warnings);
  const Rational step_um = carriage.feed_um / carriage.edges_per_revolution;
  if (step_um > plan.line.pixel_pitch_um) {
    warnings.push_back(
        "the carriage moves in steps of " + number_text(step_um) +
        " um (one A-B edge), more than scanner.pixel_pitch_um = " + number_text(plan.line.pixel_pitch_um) +
        ": carriage.encoder_pitch_um = " + number_text(carriage.encoder_pitch_um) +
        " with carriage.interpolation_bits = " + std::to_string(carriage.interpolation_bits) +
        " is too coarse to place single columns");
  }
}

std::string missing_limits(const AxisLimits& limits, const std::string& section, const std::string& unit) {
  std::string missing;
  const auto name = [&missing, &section](const std::string& key, bool is_given) {
    missing += is_given ? "" : (missing.empty() ? section + "." : ", ") + key;
  };
  name("max_speed_" + unit + "_s", limits.max_speed.has_value());
  name("max_acceleration_" + unit + "_s2", limits.max_acceleration.has_value());
  name("max_jerk_" + unit + "_s3", limits.max_jerk.has_value());
  return missing;
}

/// An axis with some of the limits that a ramp takes, or without any beside one that has them all.
void warn_limits(const Job& job, const Plan& plan, std::vector<std::string>& warnings) {
  const bool other_spins = plan.spin.has_value() || (plan.carriage && plan.carriage->spin.has_value());
  const auto check = [&](const AxisLimits& limits, const std::string& section, const std::string& unit, bool spins) {
    const bool more_than_speed = limits.max_acceleration || limits.max_jerk;
    if (!spins && (more_than_speed || other_spins)) {
      warnings.push_back(missing_limits(limits, section, unit) + ": missing, so [" + section +
                         "] is not spun up and down and must move at its marking speed from tick 0" +
                         (other_spins ? ", while the other axis starts from rest" : ""));
    }
  };
  if (plan.mode == Mode::flat) {
    check(job.stage.limits, "stage", "mm", plan.spin.has_value());
    return;
  }
  check(job.rotary.limits, "rotary", "deg", plan.spin.has_value());
  if (plan.carriage) {
    check(job.carriage.limits, "carriage", "mm", plan.carriage->spin.has_value());
  }
}

/// Terms of the error budget that have figures but are not switched on.
void warn_twin(const Job& job, std::vector<std::string>& warnings) {
  const auto check = [&](const std::string& term, bool enabled) {
    const std::string section = "twin." + term;
    for (const auto& [key, place] : job.places) {
      if (!enabled && key.size() > section.size() + 1 && key.compare(0, section.size() + 1, section + ".") == 0 &&
          key != section + ".enabled") {
        warnings.push_back(key + " has no effect: " + section + ".enabled is not true, so the term is off");
        return;
      }
    }
  };
  check("servo", job.twin.servo.enabled);
  check("run_out", job.twin.run_out.enabled);
  check("thermal", job.twin.thermal.enabled);
}

/// What the arithmetic takes and the board's registers do not (docs/registers.md): `emulate` and `run` refuse it.
void warn_board(const Job& job, const Plan& plan, std::vector<std::string>& warnings) {
  const std::int64_t multiplier = job.fpga.clock_multiplier;
  if (plan.line.offset_remainder_ticks % multiplier != 0) {
    warnings.push_back(
        "scanner.bidirectional_offset_ticks = " + std::to_string(job.scanner.bidirectional_offset_ticks) + ": leaves " +
        std::to_string(plan.line.offset_remainder_ticks) +
        " ticks beside whole slots; the board delays by whole seed clocks of " + std::to_string(multiplier) +
        " ticks and refuses it: make it a multiple of " + std::to_string(multiplier));
  }
  const auto check = [&warnings](const AbPlan& ab, const std::string& section) {
    if (ab.prescaler > static_cast<std::uint64_t>(kMostPrescaler)) {
      warnings.push_back("fpga.max_prescaler: [" + section + "] takes prescaler = " + std::to_string(ab.prescaler) +
                         "; the board's register holds 1 to " + std::to_string(kMostPrescaler) +
                         " and refuses it: make it " + std::to_string(kMostPrescaler) + " or less");
    }
    if (ab.fraction_den > static_cast<std::uint64_t>(kMostFractionDen)) {
      warnings.push_back(
          "fpga.fractional: the exact ratio of " + section +
          " takes fraction_den = " + std::to_string(ab.fraction_den) + "; the board's second accumulator holds 1 to " +
          std::to_string(kMostFractionDen) +
          " and refuses it: a shorter line, fewer lines, a simpler gear or a pitch of fewer digits makes "
          "it smaller");
    }
  };
  check(plan.ab, plan.mode == Mode::flat ? "stage" : "rotary");
  if (plan.carriage) {
    check(plan.carriage->ab, "carriage");
  }
}

/// Keys of a scanner that is not described.
void warn_scanner(const ScannerSettings& scanner, std::vector<std::string>& warnings) {
  if (scanner.field_mm) {
    return;
  }
  std::string keys;
  const auto name = [&keys](const char* key, bool is_given) {
    keys += is_given ? (keys.empty() ? "scanner." : ", ") + std::string(key) : "";
  };
  const ScannerSettings plain;
  name("resolution_bits", scanner.resolution_bits != plain.resolution_bits);
  name("lag_us", scanner.lag_us != plain.lag_us);
  name("compensate_lag", scanner.compensate_lag != plain.compensate_lag);
  name("max_speed_mm_s", scanner.max_speed_mm_s.has_value());
  name("max_acceleration_mm_s2", scanner.max_acceleration_mm_s2.has_value());
  name("max_jerk_mm_s3", scanner.max_jerk_mm_s3.has_value());
  name("cross_scan_correction", scanner.cross_scan_correction != plain.cross_scan_correction);
  name("offset_deg", scanner.offset_deg != plain.offset_deg);
  name("tilt_deg_per_mm", scanner.tilt_deg_per_mm != plain.tilt_deg_per_mm);
  name("field_grid", scanner.field_grid.has_value());
  if (!keys.empty()) {
    warnings.push_back(keys + ": without effect, for scanner.field_mm is absent and with it the scanner");
  }
}

}  // namespace

std::vector<std::string> plan_warnings(const Job& job, const Plan& plan) {
  std::vector<std::string> warnings;
  // A stage does not add up over passes: each starts where the one before ended.
  warn_drift(plan.ab, "axis", plan.mode == Mode::flat ? 1 : plan.job.revolutions,
             "fpga.fractional = true has no drift at all", warnings);
  warn_pitch(job, plan, warnings);
  warn_directions(job, plan, warnings);
  warn_start(job, plan, warnings);
  warn_encoder(plan, warnings);
  warn_scanner(job.scanner, warnings);
  warn_board(job, plan, warnings);
  warn_limits(job, plan, warnings);
  warn_twin(job, warnings);
  if (plan.carriage) {
    warn_carriage(plan, warnings);
  }
  return warnings;
}

}  // namespace gravure::sync_plan
