#include "gravure/sync/make_plan.hpp"

#include <gtest/gtest.h>

#include "gravure/sync/ab_ratio.hpp"
#include "sync_support.hpp"

namespace gravure {
namespace {

using sync_test::planned;
using sync_test::Random;
using sync_test::roller_job;
using sync_test::seed_note;
using sync_test::tube_job;

bool warned(const Plan& plan, const std::string& part) {
  for (const std::string& warning : plan.warnings) {
    if (warning.find(part) != std::string::npos) {
      return true;
    }
  }
  return false;
}

TEST(MakePlan, GivesThePublishedFiguresOfSetup1) {
  const Plan plan = planned(roller_job(), 3500, 100);
  EXPECT_EQ(plan.clock.fpga_hz, 164'000'000);
  EXPECT_EQ(plan.clock.pulse_hz, 2'000'000);
  EXPECT_EQ(plan.clock.ticks_per_slot, 82);
  EXPECT_EQ(plan.line.slots, 3909);
  EXPECT_EQ(plan.line.ticks, 3909 * 82);
  EXPECT_EQ(plan.line.scan_speed_m_s, 16);
  EXPECT_EQ(plan.rotary.lines_per_revolution, 27'489);
  EXPECT_EQ(plan.rotary.ticks_per_revolution, std::int64_t{3909} * 82 * 27'489);
  EXPECT_EQ(plan.job.ticks, plan.rotary.ticks_per_revolution * 100);
  EXPECT_EQ(plan.job.duration_s, ratio(plan.job.ticks, 164'000'000));
  EXPECT_EQ(to_string(plan.ab.wanted_increment), "208291482765885440/4405634541");
  EXPECT_EQ(plan.ab.prescaler, 3U);
  EXPECT_EQ(plan.ab.increment, 141'835'289U);
  EXPECT_EQ(to_string(plan.ab.drift_lines_per_revolution / 27'489), "17820343/208291482765885440");
  EXPECT_FALSE(plan.ab.exact);
  EXPECT_EQ(plan.line.rate_hz, ratio(2'000'000, 3909));
  EXPECT_EQ(plan.rotary.rpm, plan.line.rate_hz * 60 / 27'489);
}

/// Setup 1 with 8 um lines to the last digit and a limit of 1/16 line.
Job sixteenth_job() {
  Job job = roller_job();
  job.rotary.diameter_mm.reset();
  job.rotary.circumference_mm = ratio(27'489 * 8, 1000);
  job.fpga.max_prescaler = 1;
  job.limits.seam_um = ratio(8, 16);
  return job;
}

TEST(MakePlan, CountsLinesAndRevolutionsUntilTheLimit) {
  const Plan plan = planned(sixteenth_job(), 3500, 100);
  EXPECT_EQ(plan.rotary.line_pitch_um, 8);
  EXPECT_EQ(plan.ab.increment, 47'278'430U);
  EXPECT_EQ(*plan.ab.lines_until_limit, 8'758'425);
  EXPECT_EQ(*plan.ab.revolutions_until_limit, 319);  // 318.6: reached during the 319th
  EXPECT_EQ(plan.ab.bound_lines_until_limit, 2 * 47'278'430 / 16);
}

TEST(MakePlan, GivesThePublishedBoundOfSetup1) {
  // Encoder and gear make the published increment the wanted one.
  Job job = sixteenth_job();
  job.scanner.turn_slots = 596;
  job.rotary.interpolation_bits = 0;
  job.rotary.encoder_lines = 5'910'135 * 41;
  job.rotary.gear_encoder_turns = 27'489;
  job.rotary.gear_workpiece_turns = 65'536;
  const Plan plan = planned(job, 3500, 215);
  EXPECT_EQ(plan.ab.prescaler, 1U);
  EXPECT_EQ(plan.ab.increment, 47'281'080U);
  EXPECT_EQ(plan.ab.bound_lines_until_limit, 5'910'135);
  EXPECT_EQ(plan.ab.bound_lines_until_limit, Integer(215) * plan.rotary.lines_per_revolution);
  EXPECT_NEAR(to_double(plan.ab.output_hz), 1.80539e6, 5);
  EXPECT_TRUE(plan.ab.exact);
  EXPECT_FALSE(plan.ab.lines_until_limit.has_value());
  EXPECT_FALSE(plan.ab.revolutions_until_limit.has_value());
}

TEST(MakePlan, GivesThePublishedBoundOfSetup2) {
  Job job = tube_job();
  job.rotary.circumference_mm = ratio(942 * 6, 1000);
  job.scanner.turn_slots = 56;
  job.rotary.encoder_lines = 942 * 29;
  const Plan plan = planned(job, 1800, 742);
  EXPECT_EQ(plan.clock.pulse_hz, 5'125'000);
  EXPECT_EQ(plan.line.scan_speed_m_s, ratio(3075, 100));
  EXPECT_EQ(plan.rotary.lines_per_revolution, 942);
  EXPECT_EQ(plan.ab.prescaler, 1U);
  EXPECT_EQ(plan.ab.increment, std::uint64_t{1} << 21U);
  EXPECT_EQ(plan.ab.bound_lines_until_limit, 699'050);
  EXPECT_EQ(Integer(plan.ab.bound_lines_until_limit / 942), 742);
}

TEST(MakePlan, ReachesTheLimitOnTheLineItSays) {
  SCOPED_TRACE(seed_note());
  Random random;
  for (int trial = 0; trial < 300; ++trial) {
    Job job = tube_job();
    job.fpga.max_prescaler = random.between(1, 8);
    job.fpga.counter_bits = static_cast<int>(random.between(8, 40));
    job.rotary.encoder_lines = random.count(100, 20'000);
    job.limits.seam_um = ratio(random.count(1, 100'000), 1000);
    const Plan plan = planned(job, random.count(1000, 4000), 10);
    if (plan.ab.exact) {
      continue;
    }
    const Rational um_per_line = abs(plan.ab.drift_um_per_revolution) / Rational(plan.rotary.lines_per_revolution);
    const Integer lines = *plan.ab.lines_until_limit;
    EXPECT_GE(um_per_line * Rational(lines), plan.ab.seam_limit_um);
    EXPECT_LT(um_per_line * Rational(lines - 1), plan.ab.seam_limit_um);
    EXPECT_EQ(*plan.ab.revolutions_until_limit, ceil_of(Rational(lines, Integer(plan.rotary.lines_per_revolution))));
  }
}

TEST(MakePlan, SignsTheDriftPositiveWhenTheAxisLeads) {
  for (const bool up : {false, true}) {
    Job job = sixteenth_job();
    job.scanner.turn_slots = up ? 409 : 500;  // 47,278,430 > X at np = 3909; 46,202,845 < X at np = 4000
    const Plan plan = planned(job, 3500, 1);
    EXPECT_EQ(plan.ab.drift_lines_per_revolution > 0, up);
    EXPECT_EQ(plan.ab.output_hz > plan.ab.wanted_hz, up);
    EXPECT_EQ(plan.ab.output_hz, ratio(Integer(plan.ab.increment) * 164'000'000, Integer(1) << 32U));
  }
}

TEST(MakePlan, MultipliesTheWantedFrequencyByTheGear) {
  Job job = roller_job();
  const Plan direct = planned(job, 3500, 1);
  job.rotary.gear_encoder_turns = 3;
  job.rotary.gear_workpiece_turns = 7;
  const Plan geared = planned(job, 3500, 1);
  EXPECT_EQ(geared.ab.wanted_hz, direct.ab.wanted_hz * ratio(3, 7));
  EXPECT_EQ(geared.rotary.edges_per_revolution, direct.rotary.edges_per_revolution * ratio(3, 7));
}

/// Integers only: after the whole job the counter has added exactly what the encoder edges of its revolutions need.
TEST(MakePlan, NeverDriftsWithTheFraction) {
  SCOPED_TRACE(seed_note());
  Random random;
  int fitting = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Job job = trial % 2 == 0 ? roller_job() : tube_job();
    job.fpga.fractional = true;
    job.rotary.max_ab_hz = 40'000'000;
    job.fpga.counter_bits = trial < 2 ? 40 : static_cast<int>(random.between(8, 64));
    job.rotary.encoder_lines = random.count(100, 12'000);
    job.rotary.gear_encoder_turns = random.count(1, 9);
    job.rotary.gear_workpiece_turns = random.count(9, 30);
    const std::int64_t turns = job.rotary.gear_workpiece_turns * random.count(1, 1000);
    const Plan plan = planned(job, random.count(1000, 4000), turns);
    const AbPlan& ab = plan.ab;
    const bool fits_board = ab.fraction_den < std::uint64_t{1} << 34U;
    EXPECT_NE(fits_board, warned(plan, "the board's second accumulator holds 1 to 17179869183 and refuses it"));
    fitting += fits_board ? 1 : 0;
    EXPECT_TRUE(ab.exact);
    EXPECT_EQ(ab.drift_lines_per_revolution, 0);
    EXPECT_EQ(ab.prescaler, 1U);
    EXPECT_LT(ab.fraction_num, ab.fraction_den);
    const Integer full = Integer(1) << static_cast<unsigned>(ab.counter_bits);
    EXPECT_LE(Integer(ab.increment) + (ab.fraction_num > 0 ? 1 : 0), full / 4);
    const Integer carried = Integer(plan.job.ticks) * ab.fraction_num;
    EXPECT_EQ(carried % ab.fraction_den, 0);
    const Integer added = Integer(plan.job.ticks) * ab.increment + carried / ab.fraction_den;
    EXPECT_EQ(Rational(added), Rational(full / 4) * plan.rotary.edges_per_revolution * Rational(turns));
    EXPECT_EQ(ab.output_hz, ab.wanted_hz);
    EXPECT_FALSE(ab.lines_until_limit.has_value());
    EXPECT_FALSE(warned(plan, "leads") || warned(plan, "lags"));
  }
  EXPECT_GT(fitting, 100);
  EXPECT_LT(fitting, 300);
}

TEST(MakePlan, TakesTheLineWithTheSmallestDriftAndThenTheShortest) {
  SCOPED_TRACE(seed_note());
  Random random;
  int longer = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Job job = random.chance(2) ? roller_job() : tube_job();
    job.fpga.max_prescaler = random.between(1, 50);
    job.rotary.max_ab_hz = 40'000'000;
    job.scanner.slots_per_microvector = random.count(1, 20);
    job.scanner.max_extra_slots = random.count(0, 200);
    const std::int64_t pixels = random.count(1500, 3600);
    const Plan plan = planned(job, pixels, 1);
    Job fixed = job;
    fixed.scanner.max_extra_slots = 0;
    const std::int64_t shortest = planned(fixed, pixels, 1).line.slots;
    EXPECT_EQ(plan.line.slots % job.scanner.slots_per_microvector, 0);
    EXPECT_LE(plan.line.slots, shortest + job.scanner.max_extra_slots);
    for (std::int64_t slots = shortest; slots <= shortest + job.scanner.max_extra_slots;
         slots += job.scanner.slots_per_microvector) {
      fixed.scanner.turn_slots = slots - pixels;
      const Rational drift = abs(planned(fixed, pixels, 1).ab.drift_lines_per_revolution);
      const Rational chosen = abs(plan.ab.drift_lines_per_revolution);
      EXPECT_TRUE(slots < plan.line.slots ? drift > chosen : drift >= chosen) << slots << " or " << plan.line.slots;
    }
    longer += plan.line.slots > shortest ? 1 : 0;
  }
  EXPECT_GT(longer, 20);
}

TEST(MakePlan, IsNeverWorseThanThePublishedChoice) {
  SCOPED_TRACE(seed_note());
  Random random;
  for (int trial = 0; trial < 200; ++trial) {
    Job job = roller_job();
    job.scanner.turn_slots = random.count(409, 709);
    const Plan best = planned(job, 3500, 1);
    job.fpga.max_prescaler = 1;
    const Plan published = planned(job, 3500, 1);
    EXPECT_LE(abs(best.ab.drift_lines_per_revolution), abs(published.ab.drift_lines_per_revolution));
  }
}

TEST(MakePlan, RoundsTheLineUpToWholeMicrovectors) {
  Job job = roller_job();
  job.scanner.slots_per_microvector = 20;
  job.scanner.turn_slots = 1800;
  EXPECT_EQ(planned(job, 3500, 1).line.slots, 5300);
  EXPECT_EQ(planned(job, 3501, 1).line.slots, 5320);
  EXPECT_EQ(planned(job, 3520, 1).line.slots, 5320);
}

/// Fired backwards in time the reverse window must cover the slots of the forward one, later by the offset.
TEST(MakePlan, MirrorsTheReverseWindowAndDelaysIt) {
  for (const std::int64_t pixels : {3500, 3501}) {
    for (const std::int64_t ticks : {0, 81, 82, -81, -82, -165, 1000}) {
      Job job = roller_job();
      job.scanner.bidirectional_offset_ticks = ticks;
      const LinePlan line = planned(job, pixels, 1).line;
      EXPECT_EQ(line.forward_first_slot, (line.slots - pixels) / 2);
      const std::int64_t mirrored = line.slots - 1 - (line.forward_first_slot + pixels - 1);
      EXPECT_EQ(line.reverse_first_slot, mirrored + line.offset_slots);
      EXPECT_EQ(line.offset_slots * 82 + line.offset_remainder_ticks, ticks);
      EXPECT_LT(std::abs(line.offset_remainder_ticks), 82);
      EXPECT_GE(line.offset_remainder_ticks * ticks, 0);
    }
  }
}

TEST(MakePlan, TakesOffsetsUpToTheEndsOfTheLine) {
  Job job = roller_job();  // 3909 slots, 3500 pixels: windows from 204 and 205
  job.scanner.bidirectional_offset_ticks = 204 * 82 + 81;
  EXPECT_EQ(planned(job, 3500, 1).line.reverse_first_slot, 409);
  job.scanner.bidirectional_offset_ticks = -(205 * 82 + 81);
  EXPECT_EQ(planned(job, 3500, 1).line.reverse_first_slot, 0);
}

TEST(MakePlan, LengthensALineForItsWindowWithinExtraSlots) {
  Job job = roller_job();
  job.scanner.bidirectional_offset_ticks = 206 * 82;
  job.scanner.max_extra_slots = 3;
  const LinePlan line = planned(job, 3500, 1).line;
  EXPECT_GE(line.slots, 3912);
  EXPECT_LE(line.reverse_first_slot + line.pixels, line.slots);
}

TEST(MakePlan, TakesGivenLinesAndCircumferenceAsTheyAre) {
  Job job = roller_job();
  job.rotary.diameter_mm.reset();
  job.rotary.circumference_mm = Rational(220);
  job.rotary.line_pitch_um.reset();
  job.rotary.lines_per_revolution = 27'500;
  const Plan plan = planned(job, 3500, 1);
  EXPECT_EQ(plan.rotary.circumference_um, 220'000);
  EXPECT_EQ(plan.rotary.line_pitch_um, 8);
  EXPECT_EQ(plan.rotary.lines_per_revolution, 27'500);
  EXPECT_EQ(plan.rotary.surface_speed_mm_s, plan.line.rate_hz * ratio(8, 1000));
  EXPECT_TRUE(plan.warnings.empty()) << plan.warnings.front();
}

TEST(MakePlan, WarnsOfAxesThatCannotBeSpunUpForWantOfALimit) {
  Job job = roller_job();
  job.rotary.limits.max_acceleration = 1000;
  EXPECT_TRUE(warned(planned(job, 3500, 1),
                     "rotary.max_speed_deg_s, max_jerk_deg_s3: missing, so [rotary] is not spun up and down"));
  job.rotary.limits = {100, {}, {}};
  EXPECT_FALSE(warned(planned(job, 3500, 1), "missing")) << "a speed alone is checked against that of marking";
  job.mode = Mode::helical;
  job.carriage = {64, 2, 20, 8, 2'000'000, {}};
  job.rotary.max_ab_hz = 40'000'000;
  job.rotary.limits = {36'000, 36'000, 360'000};
  const Result<Plan> made = make_plan(job, 3500, 2);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(warned(made.value(),
                     "carriage.max_speed_mm_s, max_acceleration_mm_s2, max_jerk_mm_s3: missing, so [carriage] is "
                     "not spun up and down and must move at its marking speed from tick 0, while the other axis "
                     "starts from rest"));
}

TEST(MakePlan, WarnsOfOffsetsThatTheBoardRefuses) {
  Job job = roller_job();
  job.scanner.bidirectional_offset_ticks = -1;
  EXPECT_TRUE(warned(planned(job, 3500, 1), "the board delays by whole seed clocks of 2 ticks and refuses it"));
  job.scanner.bidirectional_offset_ticks = -2;
  EXPECT_FALSE(warned(planned(job, 3500, 1), "refuses it"));
}

TEST(MakePlan, WarnsOfFiguresOfTermsThatAreOff) {
  Job job = roller_job();
  job.places["twin.servo.bandwidth_hz"] = {7, 1};
  job.places["twin.run_out.enabled"] = {8, 1};
  const Plan plan = planned(job, 3500, 1);
  EXPECT_TRUE(
      warned(plan, "twin.servo.bandwidth_hz has no effect: twin.servo.enabled is not true, so the term is off"));
  EXPECT_FALSE(warned(plan, "run_out"));
  job.twin.servo.enabled = true;
  EXPECT_FALSE(warned(planned(job, 3500, 1), "has no effect"));
}

TEST(MakePlan, WarnsOfWhatIsAllowedButWorthKnowing) {
  Job job = roller_job();
  EXPECT_TRUE(warned(planned(job, 3500, 1), "27489 is odd"));
  job.scanner.bidirectional = false;
  EXPECT_TRUE(planned(job, 3500, 1).warnings.empty());
  job.scanner.bidirectional_offset_ticks = 100;
  const Plan one_way = planned(job, 3500, 1);
  EXPECT_TRUE(warned(one_way, "bidirectional_offset_ticks = 100 has no effect"));
  EXPECT_EQ(one_way.line.offset_slots, 0);
  EXPECT_EQ(one_way.line.offset_remainder_ticks, 0);

  Job drifting = sixteenth_job();
  drifting.scanner.bidirectional = false;
  EXPECT_FALSE(warned(planned(drifting, 3500, 318), "leads"));
  EXPECT_TRUE(warned(planned(drifting, 3500, 319), "after 319 revolutions the axis leads by 0.500"));
  EXPECT_TRUE(warned(planned(drifting, 3500, 319), "8758425 lines, in revolution 319"));
  drifting.scanner.turn_slots = 500;
  EXPECT_TRUE(warned(planned(drifting, 3500, 100'000), "the axis lags by"));

  Job rounded = tube_job();
  rounded.rotary.line_pitch_um = Rational(11);
  EXPECT_FALSE(warned(planned(rounded, 1500, 1), "becomes"));
  rounded.rotary.line_pitch_um = Rational(100);  // 56.58 lines become 57
  EXPECT_TRUE(
      warned(planned(rounded, 1500, 1), "rotary.line_pitch_um = 100 becomes 99.2631579 um (0.736842105 % off)"));

  Job coarse = tube_job();
  coarse.rotary.encoder_lines = 235;  // 940 edges, 943 lines
  EXPECT_TRUE(warned(planned(coarse, 1500, 1), "steps of 6.0191489"));
  coarse.rotary.encoder_lines = 236;
  EXPECT_FALSE(warned(planned(coarse, 1500, 1), "steps of"));
}

TEST(MakePlan, StaysInsideEveryBoundForRandomJobs) {
  SCOPED_TRACE(seed_note());
  Random random;
  int planned_jobs = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    Job job = roller_job();
    job.laser.pulse_divider = random.count(1, 200);
    job.fpga.counter_bits = static_cast<int>(random.between(8, 64));
    job.fpga.max_prescaler = random.between(1, std::numeric_limits<std::uint64_t>::max());
    job.fpga.fractional = random.chance(3);
    job.scanner.slots_per_microvector = random.count(1, 50);
    job.rotary.interpolation_bits = static_cast<int>(random.between(0, 16));
    job.rotary.max_ab_hz = random.count(10'000, 4'000'000);
    job.scanner.bidirectional_offset_ticks = random.count(0, 40'000) - 20'000;
    const Result<Plan> result = make_plan(job, random.count(1, 5000), random.count(1, 10'000));
    if (!result) {
      EXPECT_EQ(result.error().code, ErrorCode::out_of_range) << result.error().message;
      continue;
    }
    ++planned_jobs;
    const Plan& plan = result.value();
    EXPECT_LE(plan.ab.output_hz, Rational(job.rotary.max_ab_hz));
    EXPECT_LE(plan.ab.increment, largest_increment(job.fpga.counter_bits));
    EXPECT_GE(plan.ab.prescaler, 1U);
    EXPECT_LE(plan.ab.prescaler, job.fpga.max_prescaler);
    EXPECT_LE(plan.clock.pulse_hz, Rational(job.laser.max_pulse_on_demand_hz));
    EXPECT_GE(plan.line.reverse_first_slot, 0);
    EXPECT_LE(plan.line.reverse_first_slot + plan.line.pixels, plan.line.slots);
    EXPECT_EQ(plan.ab.drift_lines_per_revolution,
              (plan.ab.output_hz / plan.ab.wanted_hz - 1) * Rational(plan.rotary.lines_per_revolution));
  }
  EXPECT_GT(planned_jobs, 200);
}

}  // namespace
}  // namespace gravure
