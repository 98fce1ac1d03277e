#include "check_plan.hpp"

#include <optional>
#include <string>

namespace gravure::plan_json {
namespace {

/// Keeps the first complaint.
class Complaint {
 public:
  void unless(bool fine, const char* key, const std::string& problem) {
    if (!fine && !error_) {
      error_ = Error{ErrorCode::bad_file, std::string("plan: ") + key + " " + problem};
    }
  }
  void least_one(const char* key, const Integer& value) {
    unless(value >= 1, key, "= " + to_string(value) + ": must be at least 1");
  }
  void positive(const char* key, const Rational& value) {
    unless(value > 0, key, "= " + to_string(value).substr(0, kShown) + ": must be greater than 0");
  }
  /// A figure that follows from the others.
  void equal(const char* key, const Rational& value, const Rational& expected) {
    unless(value == expected, key,
           "= " + to_string(value).substr(0, kShown) + ": the rest of the plan gives " +
               to_string(expected).substr(0, kShown));
  }
  Result<void> result() const { return error_ ? Result<void>(*error_) : Result<void>(); }
  bool none() const { return !error_; }

 private:
  static constexpr std::size_t kShown = 80;
  std::optional<Error> error_;
};

/// What later checks, and everybody else, divide by or shift by.
void check_divisors(const Plan& plan, Complaint& complaint) {
  complaint.least_one("clock.seed_hz", plan.clock.seed_hz);
  complaint.least_one("clock.fpga_hz", plan.clock.fpga_hz);
  complaint.least_one("clock.pulse_divider", plan.clock.pulse_divider);
  complaint.least_one("clock.ticks_per_slot", plan.clock.ticks_per_slot);
  complaint.least_one("line.pixels", plan.line.pixels);
  complaint.least_one("line.slots", plan.line.slots);
  complaint.least_one("line.slots_per_microvector", plan.line.slots_per_microvector);
  complaint.positive("line.pixel_pitch_um", plan.line.pixel_pitch_um);
  complaint.least_one("rotary.lines_per_revolution", plan.rotary.lines_per_revolution);
  complaint.positive("rotary.circumference_um", plan.rotary.circumference_um);
  complaint.least_one("rotary.encoder_lines", plan.rotary.encoder_lines);
  complaint.unless(plan.rotary.interpolation_bits <= 63, "rotary.interpolation_bits", "must be 0 to 63");
  complaint.least_one("rotary.gear_encoder_turns", plan.rotary.gear_encoder_turns);
  complaint.least_one("rotary.gear_workpiece_turns", plan.rotary.gear_workpiece_turns);
  complaint.least_one("ab.prescaler", plan.ab.prescaler);
  complaint.least_one("ab.fraction.den", plan.ab.fraction_den);
  complaint.unless(plan.ab.counter_bits >= 2 && plan.ab.counter_bits <= 64, "ab.counter_bits", "must be 2 to 64");
  complaint.positive("ab.seam_limit_um", plan.ab.seam_limit_um);
  complaint.least_one("job.revolutions", plan.job.revolutions);
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
  complaint.equal("rotary.rpm", rotary.rpm, revolutions_per_second * Rational(60));
  complaint.equal("rotary.surface_speed_mm_s", rotary.surface_speed_mm_s,
                  revolutions_per_second * rotary.circumference_um / Rational(1000));
  complaint.equal("rotary.edges_per_revolution", rotary.edges_per_revolution,
                  ratio((Integer(4) << static_cast<unsigned>(rotary.interpolation_bits)) * rotary.encoder_lines *
                            rotary.gear_encoder_turns,
                        rotary.gear_workpiece_turns));
  complaint.equal("job.ticks", plan.job.ticks, Integer(rotary.ticks_per_revolution) * plan.job.revolutions);
  complaint.equal("job.duration_s", plan.job.duration_s, ratio(plan.job.ticks, plan.clock.fpga_hz));
}

void check_frequencies(const Plan& plan, Complaint& complaint) {
  const AbPlan& ab = plan.ab;
  const Integer full = Integer(1) << static_cast<unsigned>(ab.counter_bits);
  const Rational per_clock =
      (Rational(ab.increment) + Rational(Integer(ab.fraction_num), Integer(ab.fraction_den))) / Rational(ab.prescaler);
  complaint.unless(ab.fraction_num < ab.fraction_den, "ab.fraction.num", "must be less than ab.fraction.den");
  complaint.unless(Integer(ab.increment) + (ab.fraction_num > 0 ? 1 : 0) <= full / 4, "ab.increment",
                   "lets A and B change together: increment and carry must be at most 2^(n-2)");
  complaint.unless(per_clock > 0, "ab.increment", "= 0: the axis would stand still");
  complaint.equal(
      "ab.wanted_hz", ab.wanted_hz,
      plan.line.rate_hz / Rational(plan.rotary.lines_per_revolution) * plan.rotary.edges_per_revolution / Rational(4));
  complaint.equal("ab.output_hz", ab.output_hz, per_clock * Rational(plan.clock.fpga_hz) / Rational(full));
  complaint.unless(ab.output_hz <= Rational(ab.max_output_hz), "ab.output_hz", "is above ab.max_output_hz");
  complaint.equal("ab.wanted_increment", ab.wanted_increment,
                  ab.wanted_hz * Rational(full) / Rational(plan.clock.fpga_hz));
}

void check_drift(const Plan& plan, Complaint& complaint) {
  const AbPlan& ab = plan.ab;
  const Rational relative = ab.output_hz / ab.wanted_hz - Rational(1);
  const Rational limit_lines = ab.seam_limit_um / plan.rotary.line_pitch_um;
  complaint.unless(ab.exact == (relative == 0), "ab.exact", "does not follow from output_hz and wanted_hz");
  complaint.equal("ab.drift_lines_per_revolution", ab.drift_lines_per_revolution,
                  relative * Rational(plan.rotary.lines_per_revolution));
  complaint.equal("ab.drift_um_per_revolution", ab.drift_um_per_revolution,
                  ab.drift_lines_per_revolution * plan.rotary.line_pitch_um);
  complaint.unless(ab.lines_until_limit.has_value() == !ab.exact, "ab.lines_until_limit",
                   "must be null for an exact ratio, and for no other");
  complaint.unless(ab.revolutions_until_limit.has_value() == !ab.exact, "ab.revolutions_until_limit",
                   "must be null for an exact ratio, and for no other");
  if (!complaint.none()) {
    return;
  }
  if (!ab.exact) {
    complaint.equal("ab.lines_until_limit", *ab.lines_until_limit, ceil_of(limit_lines / abs(relative)));
    complaint.equal("ab.revolutions_until_limit", *ab.revolutions_until_limit,
                    ceil_of(Rational(*ab.lines_until_limit, Integer(plan.rotary.lines_per_revolution))));
  }
  complaint.equal("ab.bound_lines_until_limit", ab.bound_lines_until_limit,
                  floor_of(Rational(2) * Rational(ab.increment) * limit_lines));
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
  part([&] { check_rotary(plan, complaint); });
  part([&] { check_frequencies(plan, complaint); });
  part([&] { check_drift(plan, complaint); });
  return complaint.result();
}

}  // namespace gravure::plan_json
