#include "check_plan.hpp"

#include <optional>
#include <string>

#include "check_path.hpp"
#include "complaint.hpp"
#include "gravure/core/board_runs.hpp"
#include "gravure/core/exposure_map.hpp"
#include "gravure/core/spin_phase.hpp"

namespace gravure::plan_json {
namespace {

void check_counter(const AbPlan& ab, const std::string& section, Complaint& complaint) {
  complaint.least_one(section + "prescaler", ab.prescaler);
  complaint.least_one(section + "fraction.den", ab.fraction_den);
  complaint.unless(ab.counter_bits >= 2 && ab.counter_bits <= 64, section + "counter_bits", "must be 2 to 64");
  complaint.positive(section + "seam_limit_um", ab.seam_limit_um);
}

/// What later checks, and everybody else, divide by or shift by.
void check_divisors(const Plan& plan, Complaint& complaint) {
  complaint.unless(plan.path.has_value() == follows_path(plan.mode), "path",
                   "must be there in the modes that follow a path, and in no other");
  complaint.least_one("clock.seed_hz", plan.clock.seed_hz);
  complaint.least_one("clock.fpga_hz", plan.clock.fpga_hz);
  complaint.least_one("clock.pulse_divider", plan.clock.pulse_divider);
  complaint.least_one("clock.ticks_per_slot", plan.clock.ticks_per_slot);
  complaint.least_one("line.pixels", plan.line.pixels);
  complaint.least_one("line.slots", plan.line.slots);
  complaint.least_one("line.slots_per_microvector", plan.line.slots_per_microvector);
  complaint.positive("line.pixel_pitch_um", plan.line.pixel_pitch_um);
  complaint.least_one("rotary.lines_per_revolution", plan.rotary.lines_per_revolution);
  complaint.least_one("job.revolutions", plan.job.revolutions);
  complaint.unless(plan.carriage.has_value() == (plan.mode == Mode::helical), "carriage",
                   "must be there in helical mode, and in no other");
  if (plan.path) {
    return;
  }
  complaint.positive("rotary.circumference_um", plan.rotary.circumference_um);
  if (plan.mode == Mode::flat) {
    complaint.positive("stage.encoder_pitch_um", plan.rotary.encoder_pitch_um);
  } else {
    complaint.least_one("rotary.encoder_lines", plan.rotary.encoder_lines);
  }
  complaint.unless(plan.rotary.interpolation_bits <= 63, "rotary.interpolation_bits", "must be 0 to 63");
  complaint.least_one("rotary.gear_encoder_turns", plan.rotary.gear_encoder_turns);
  complaint.least_one("rotary.gear_workpiece_turns", plan.rotary.gear_workpiece_turns);
  check_counter(plan.ab, "ab.", complaint);
  complaint.unless(!plan.bands || plan.mode != Mode::helical, "bands", "are none in helical mode");
  if (plan.carriage) {
    complaint.positive("carriage.feed_pixels", plan.carriage->feed_pixels);
    complaint.least_one("carriage.layers", plan.carriage->layers);
    complaint.least_one("carriage.columns", plan.carriage->columns);
    complaint.positive("carriage.encoder_pitch_um", plan.carriage->encoder_pitch_um);
    complaint.unless(plan.carriage->interpolation_bits <= 63, "carriage.interpolation_bits", "must be 0 to 63");
    check_counter(plan.carriage->ab, "carriage.ab.", complaint);
  }
}

void check_clock(const ClockPlan& clock, Complaint& complaint) {
  complaint.unless(clock.fpga_hz % clock.seed_hz == 0, "clock.fpga_hz", "is not a multiple of clock.seed_hz");
  complaint.equal("clock.pulse_hz", clock.pulse_hz, ratio(clock.seed_hz, clock.pulse_divider));
  complaint.equal("clock.ticks_per_slot", clock.ticks_per_slot, ratio(clock.fpga_hz, 1) / clock.pulse_hz);
}

void check_line(const Plan& plan, Complaint& complaint) {
  const LinePlan& line = plan.line;
  const std::int64_t last_first_slot = line.slots - line.pixels;
  const auto inside = [&](std::int64_t first) { return first >= 0 && first <= last_first_slot; };
  complaint.unless(line.slots % line.slots_per_microvector == 0, "line.slots", "is not a number of whole microvectors");
  complaint.unless(inside(line.forward_first_slot), "line.marking_first_slot.forward",
                   "puts the marking window out of the line");
  complaint.unless(inside(line.reverse_first_slot), "line.marking_first_slot.reverse",
                   "puts the marking window out of the line");
  complaint.equal("line.offset_slots", line.offset_slots,
                  Integer(line.reverse_first_slot) - (Integer(last_first_slot) - line.forward_first_slot));
  const std::int64_t rest = line.offset_remainder_ticks;
  complaint.unless(rest < plan.clock.ticks_per_slot && rest > -plan.clock.ticks_per_slot, "line.offset_remainder_ticks",
                   "must be less than a slot");
  complaint.equal("line.ticks", line.ticks, Integer(line.slots) * plan.clock.ticks_per_slot);
  complaint.equal("line.rate_hz", line.rate_hz, plan.clock.pulse_hz / Rational(line.slots));
  complaint.equal("line.scan_speed_m_s", line.scan_speed_m_s,
                  line.pixel_pitch_um * plan.clock.pulse_hz / Rational(1'000'000));
}

void check_rotary(const Plan& plan, Complaint& complaint) {
  const RotaryPlan& rotary = plan.rotary;
  const Rational revolutions_per_second = plan.line.rate_hz / Rational(rotary.lines_per_revolution);
  complaint.equal("rotary.line_pitch_um", rotary.line_pitch_um,
                  rotary.circumference_um / Rational(rotary.lines_per_revolution));
  complaint.equal("rotary.ticks_per_revolution", rotary.ticks_per_revolution,
                  Integer(plan.line.ticks) * rotary.lines_per_revolution);
  complaint.equal("rotary.rpm", rotary.rpm,
                  plan.mode == Mode::flat ? Rational(0) : revolutions_per_second * Rational(60));
  complaint.equal("rotary.surface_speed_mm_s", rotary.surface_speed_mm_s,
                  revolutions_per_second * rotary.circumference_um / Rational(1000));
  const Rational interpolated = Integer(4) << static_cast<unsigned>(rotary.interpolation_bits);
  complaint.equal("rotary.edges_per_revolution", rotary.edges_per_revolution,
                  plan.mode == Mode::flat
                      ? interpolated * rotary.circumference_um / rotary.encoder_pitch_um
                      : interpolated * ratio(Integer(rotary.encoder_lines) * rotary.gear_encoder_turns,
                                             rotary.gear_workpiece_turns));
  complaint.equal("job.ticks", plan.job.ticks, Integer(rotary.ticks_per_revolution) * plan.job.revolutions);
  complaint.equal("job.duration_s", plan.job.duration_s, ratio(plan.job.ticks, plan.clock.fpga_hz));
}

void check_carriage(const Plan& plan, Complaint& complaint) {
  const CarriagePlan& carriage = *plan.carriage;
  const Rational revolutions_per_second = plan.line.rate_hz / Rational(plan.rotary.lines_per_revolution);
  complaint.unless(ExposureMap::fits(carriage.feed_pixels, plan.rotary.lines_per_revolution), "carriage.feed_pixels",
                   "is, over the lines of a revolution, a ratio beyond 62-bit integers");
  complaint.equal("carriage.feed_um", carriage.feed_um, carriage.feed_pixels * plan.line.pixel_pitch_um);
  complaint.equal("carriage.window_columns", carriage.window_columns,
                  ceil_of(carriage.feed_pixels * Rational(carriage.layers)));
  complaint.equal("line.pixels", plan.line.pixels, carriage.window_columns);
  complaint.equal("carriage.revolutions", carriage.revolutions,
                  ceil_of(Rational(carriage.columns) / carriage.feed_pixels) + carriage.layers);
  complaint.equal("job.revolutions", plan.job.revolutions, carriage.revolutions);
  complaint.equal("carriage.travel_mm", carriage.travel_mm,
                  carriage.feed_um * Rational(carriage.revolutions) / Rational(1000));
  complaint.equal("carriage.speed_mm_s", carriage.speed_mm_s,
                  revolutions_per_second * carriage.feed_um / Rational(1000));
  complaint.equal("carriage.edges_per_revolution", carriage.edges_per_revolution,
                  Rational(Integer(4) << static_cast<unsigned>(carriage.interpolation_bits)) * carriage.feed_um /
                      carriage.encoder_pitch_um);
}

void check_bands(const Plan& plan, Complaint& complaint) {
  const BandsPlan& bands = *plan.bands;
  complaint.least_one("bands.revolutions_per_band", bands.revolutions_per_band);
  complaint.unless(bands.columns > plan.line.pixels, "bands.columns", "fit one band");
  complaint.equal("bands.count", bands.count, ceil_of(ratio(bands.columns, plan.line.pixels)));
  complaint.equal("job.revolutions", plan.job.revolutions, Integer(bands.count) * bands.revolutions_per_band);
  complaint.equal("bands.step_mm", bands.step_mm,
                  plan.line.pixel_pitch_um * Rational(plan.line.pixels) / Rational(1000));
}

void check_scanner(const Plan& plan, Complaint& complaint) {
  const ScannerPlan& scanner = *plan.scanner;
  complaint.positive("scanner.field_mm", scanner.field_mm);
  complaint.unless(Rational(plan.line.pixels) * plan.line.pixel_pitch_um <= scanner.field_mm * Rational(1000),
                   "scanner.field_mm", "does not hold the pixels of a line");
  complaint.unless(scanner.resolution_bits >= 8 && scanner.resolution_bits <= 26, "scanner.resolution_bits",
                   "must be 8 to 26");
  complaint.unless(scanner.lag_us >= 0, "scanner.lag_us", "must be 0 or more");
  complaint.unless(scanner.tilt_deg_per_mm >= 0, "scanner.tilt_deg_per_mm", "must be 0 or more");
  complaint.unless(abs(scanner.offset_deg) <= Rational(plan.mode == Mode::flat ? 0 : 85), "scanner.offset_deg",
                   "must be -85 to 85, 0 in flat mode");
  const auto limit = [&complaint](const char* key, const std::optional<Rational>& value) {
    if (value) {
      complaint.positive(key, *value);
    }
  };
  limit("scanner.max_speed_mm_s", scanner.max_speed_mm_s);
  limit("scanner.max_acceleration_mm_s2", scanner.max_acceleration_mm_s2);
  limit("scanner.max_jerk_mm_s3", scanner.max_jerk_mm_s3);
  complaint.unless(scanner.field_grid.size() <= kMostPlanGridBytes, "scanner.field_grid",
                   "has more than " + std::to_string(kMostPlanGridBytes) + " bytes");
}

/// What a channel is held against: its place in the plan, and what its axis does in a revolution.
struct Channel {
  const AbPlan& ab;
  std::string section;
  Rational edges_per_revolution;
  Rational travel_um;
};

void check_frequencies(const Plan& plan, const Channel& channel, Complaint& complaint) {
  const AbPlan& ab = channel.ab;
  const Integer full = Integer(1) << static_cast<unsigned>(ab.counter_bits);
  const Rational per_clock =
      (Rational(ab.increment) + Rational(Integer(ab.fraction_num), Integer(ab.fraction_den))) / Rational(ab.prescaler);
  complaint.unless(ab.fraction_num < ab.fraction_den, channel.section + "fraction.num",
                   "must be less than ab.fraction.den");
  complaint.unless(Integer(ab.increment) + (ab.fraction_num > 0 ? 1 : 0) <= full / 4, channel.section + "increment",
                   "lets A and B change together: increment and carry must be at most 2^(n-2)");
  complaint.unless(per_clock > 0, channel.section + "increment", "= 0: the axis would stand still");
  complaint.equal(
      channel.section + "wanted_hz", ab.wanted_hz,
      plan.line.rate_hz / Rational(plan.rotary.lines_per_revolution) * channel.edges_per_revolution / Rational(4));
  complaint.equal(channel.section + "output_hz", ab.output_hz,
                  per_clock * Rational(plan.clock.fpga_hz) / Rational(full));
  complaint.unless(ab.output_hz <= Rational(ab.max_output_hz), channel.section + "output_hz",
                   "is above ab.max_output_hz");
  complaint.equal(channel.section + "wanted_increment", ab.wanted_increment,
                  ab.wanted_hz * Rational(full) / Rational(plan.clock.fpga_hz));
}

void check_drift(const Plan& plan, const Channel& channel, Complaint& complaint) {
  const AbPlan& ab = channel.ab;
  const Rational travel_per_line_um = channel.travel_um / Rational(plan.rotary.lines_per_revolution);
  const Rational relative = ab.output_hz / ab.wanted_hz - Rational(1);
  const Rational limit_lines = ab.seam_limit_um / travel_per_line_um;
  complaint.unless(ab.exact == (relative == 0), channel.section + "exact",
                   "does not follow from output_hz and wanted_hz");
  complaint.equal(channel.section + "drift_lines_per_revolution", ab.drift_lines_per_revolution,
                  relative * Rational(plan.rotary.lines_per_revolution));
  complaint.equal(channel.section + "drift_um_per_revolution", ab.drift_um_per_revolution,
                  ab.drift_lines_per_revolution * travel_per_line_um);
  if (!complaint.none()) {
    return;
  }
  const Integer lines = ab.exact ? Integer(0) : ceil_of(limit_lines / abs(relative));
  // A stage that keeps within the limit for a pass does so for ever.
  const bool reached = !ab.exact && (plan.mode != Mode::flat || lines <= plan.rotary.lines_per_revolution);
  complaint.unless(ab.lines_until_limit.has_value() == reached, channel.section + "lines_until_limit",
                   reached ? "is null, but the limit is reached" : "must be null: the limit is never reached");
  complaint.unless(ab.revolutions_until_limit.has_value() == reached, channel.section + "revolutions_until_limit",
                   reached ? "is null, but the limit is reached" : "must be null: the limit is never reached");
  if (!complaint.none()) {
    return;
  }
  if (reached) {
    complaint.equal(channel.section + "lines_until_limit", *ab.lines_until_limit, lines);
    complaint.equal(channel.section + "revolutions_until_limit", *ab.revolutions_until_limit,
                    ceil_of(Rational(lines, Integer(plan.rotary.lines_per_revolution))));
  }
  complaint.equal(channel.section + "bound_lines_until_limit", ab.bound_lines_until_limit,
                  floor_of(Rational(2) * Rational(ab.increment) * limit_lines));
}

constexpr std::int64_t kMostSeeds = 4'294'967'295;  // the board's schedule_seeds and first_tick

constexpr std::int64_t kMostTicksPerSeed = 1'000'000;

/// An axis that is spun up and down: its channel and what a degree or mm of it is.
struct SpinChannel {
  const AbPlan& ab;
  const AxisSpin& spin;
  std::string section;
  Rational edges_per_unit;
};

/// The segments of a ramp, and the ticks they last together.
Integer check_segments(const SpinChannel& channel, const SpinPlan& ramp, std::int64_t ticks_per_seed,
                       const std::string& key, Complaint& complaint) {
  Integer ticks = 0;
  for (const SpinSegment& segment : ramp.segments) {
    const bool stands = segment.increment == 0 && channel.ab.fraction_num == 0;
    const Integer length = Integer(segment.seeds) * ticks_per_seed;
    complaint.unless(segment.seeds >= 1 && segment.seeds <= kMostSeeds, key + "segments",
                     "last 1 to " + std::to_string(kMostSeeds) + " seed clocks each");
    complaint.unless(segment.increment <= channel.ab.increment, key + "segments", "are faster than marking");
    complaint.unless(stands || length % Integer(channel.ab.prescaler) == 0, key + "segments",
                     "are no whole steps of the prescaler");
    ticks += length;
  }
  complaint.unless(!ramp.segments.empty(), key + "segments", "are none");
  complaint.equal(key + "ticks", ramp.ticks, ticks);
  return ticks;
}

/// Figures that follow from the segments; `before` is where the counter stands at their begin.
void check_ramp(const Plan& plan, const SpinChannel& channel, const SpinPlan& ramp, const std::string& key,
                const SpinPhase& before, Complaint& complaint) {
  const std::int64_t ticks_per_seed = plan.clock.fpga_hz / plan.clock.seed_hz;
  check_segments(channel, ramp, ticks_per_seed, key, complaint);
  if (!complaint.none()) {
    return;
  }
  const Integer edge = Integer(1) << static_cast<unsigned>(channel.ab.counter_bits - 2);
  complaint.equal(key + "counts", ramp.counts,
                  phase_after(channel.ab, ramp.segments, ticks_per_seed, before).counts - before.counts);
  complaint.equal(key + "travel", ramp.travel, Rational(ramp.counts) / Rational(edge) / channel.edges_per_unit);
  complaint.equal(key + "duration_s", ramp.duration_s, ratio(ramp.ticks, plan.clock.fpga_hz));
}

void check_spin(const Plan& plan, const SpinChannel& channel, Complaint& complaint) {
  const std::int64_t ticks_per_seed = plan.clock.fpga_hz / plan.clock.seed_hz;
  const AxisSpin& spin = channel.spin;
  const bool flat = plan.mode == Mode::flat;
  complaint.unless(ticks_per_seed <= kMostTicksPerSeed, "clock.fpga_hz", "is too many times clock.seed_hz for a spin");
  if (!complaint.none()) {
    return;
  }
  check_ramp(plan, channel, spin.up, channel.section + "up.", {}, complaint);
  if (!complaint.none()) {
    return;
  }
  complaint.unless(spin.up.ticks / ticks_per_seed <= kMostSeeds, channel.section + "up.ticks",
                   "are more than the board counts to the first line");
  SpinPhase phase = phase_after(channel.ab, spin.up.segments, ticks_per_seed, {});
  phase = phase_after(channel.ab, channel.ab.increment, run_with(plan, 0).ticks, phase);
  check_ramp(plan, channel, spin.down, channel.section + "down.", phase, complaint);
  const Integer edge = Integer(1) << static_cast<unsigned>(channel.ab.counter_bits - 2);
  const bool turns = !flat && &channel.ab == &plan.ab;
  complaint.equal(channel.section + "start_error_deg", spin.start_error_deg,
                  turns ? Rational(spin.up.travel - spin.start_deg) : Rational(0));
  complaint.unless((phase.counts + spin.down.counts) / edge % 4 == 0, channel.section + "down.counts",
                   "do not bring the axis to rest on an A-B period");
  complaint.unless(!flat || abs(way_back_lead(plan)) <= 1, channel.section + "down.counts",
                   "do not bring the stage to where its way back begins");
  const std::int64_t runs = plan.job.revolutions / run_with(plan, 0).revolutions;
  complaint.equal(channel.section + "total_s", spin.total_s,
                  plan.job.duration_s + (spin.up.duration_s + spin.down.duration_s) * Rational(runs));
}

/// A degree of the workpiece, a mm of the stage.
SpinChannel cross_scan_spin(const Plan& plan) {
  const Rational units =
      plan.mode == Mode::flat ? Rational(plan.rotary.circumference_um / Rational(1000)) : Rational(360);
  return {plan.ab, *plan.spin, "spin.", plan.rotary.edges_per_revolution / units};
}

}  // namespace

Result<void> check_plan(const Plan& plan) {
  Complaint complaint;
  const auto part = [&complaint](const auto& check) {
    if (complaint.none()) {
      check();
    }
  };
  part([&] { check_divisors(plan, complaint); });
  part([&] { check_clock(plan.clock, complaint); });
  part([&] { check_line(plan, complaint); });
  if (plan.path) {
    part([&] { check_path(plan, complaint); });
    return complaint.result();
  }
  part([&] { check_rotary(plan, complaint); });
  if (plan.carriage) {
    part([&] { check_carriage(plan, complaint); });
  }
  if (plan.bands) {
    part([&] { check_bands(plan, complaint); });
  }
  if (plan.scanner) {
    part([&] { check_scanner(plan, complaint); });
  }
  const auto channel = [&](const Channel& its) {
    part([&] { check_frequencies(plan, its, complaint); });
    part([&] { check_drift(plan, its, complaint); });
  };
  channel({plan.ab, "ab.", plan.rotary.edges_per_revolution, plan.rotary.circumference_um});
  if (plan.carriage) {
    channel({plan.carriage->ab, "carriage.ab.", plan.carriage->edges_per_revolution, plan.carriage->feed_um});
  }
  if (plan.spin) {
    part([&] { check_spin(plan, cross_scan_spin(plan), complaint); });
  }
  if (plan.carriage && plan.carriage->spin) {
    const CarriagePlan& carriage = *plan.carriage;
    part([&] {
      check_spin(plan,
                 {carriage.ab, *carriage.spin, "carriage.spin.",
                  carriage.edges_per_revolution * Rational(1000) / carriage.feed_um},
                 complaint);
    });
  }
  return complaint.result();
}

}  // namespace gravure::plan_json
