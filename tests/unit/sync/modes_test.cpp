#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "gravure/sync/ab_ratio.hpp"
#include "sync_support.hpp"

namespace gravure {
namespace {

using sync_test::planned;
using sync_test::Random;
using sync_test::roller_job;
using sync_test::seed_note;

/// The roller with a carriage: 8 layers in one pass.
Job helical_job() {
  Job job = roller_job();
  job.mode = Mode::helical;
  job.rotary.interpolation_bits = 7;  // short lines, so it turns faster
  job.carriage = {.feed_pixels = 64,
                  .layers = 8,
                  .encoder_pitch_um = 20,
                  .interpolation_bits = 8,
                  .max_ab_hz = 2'000'000,
                  .limits = {}};
  return job;
}

Job flat_job() {
  Job job = roller_job();
  job.mode = Mode::flat;
  job.rotary = {};
  job.stage = {.lines = 5000,
               .line_pitch_um = 8,
               .encoder_pitch_um = 20,
               .interpolation_bits = 8,
               .max_ab_hz = 2'000'000,
               .limits = {}};
  return job;
}

Rational emitted_hz(const AbPlan& ab, const Plan& plan) {
  const Rational per_clock =
      (Rational(ab.increment) + Rational(Integer(ab.fraction_num), Integer(ab.fraction_den))) / Rational(ab.prescaler);
  return per_clock * Rational(plan.clock.fpga_hz) / Rational(Integer(1) << static_cast<unsigned>(ab.counter_bits));
}

TEST(HelicalPlan, HasWindowTurnsAndTravelOfItsFeed) {
  const Plan plan = planned(helical_job(), 15'000, 8);
  ASSERT_TRUE(plan.carriage);
  const CarriagePlan& carriage = *plan.carriage;
  EXPECT_EQ(carriage.feed_um, Rational(512));
  EXPECT_EQ(carriage.window_columns, 512);
  EXPECT_EQ(plan.line.pixels, 512);
  EXPECT_EQ(carriage.revolutions, 8 + 235);  // 15000 / 64 = 234.4
  EXPECT_EQ(plan.job.revolutions, 243);
  EXPECT_EQ(plan.job.ticks, plan.rotary.ticks_per_revolution * 243);
  EXPECT_EQ(carriage.travel_mm, Rational(243 * 512) / 1000);
  EXPECT_EQ(carriage.edges_per_revolution, Rational(512) / 20 * 1024);
  EXPECT_EQ(image_columns(plan), 15'000);
  EXPECT_FALSE(plan.bands);
}

TEST(HelicalPlan, SolvesTheCarriageByItsBestPairEvenWhereTheRotaryAxisHasAFraction) {
  SCOPED_TRACE(seed_note());
  Random random;
  for (int trial = 0; trial < 60; ++trial) {
    Job job = helical_job();
    job.fpga.fractional = random.chance(3);
    job.fpga.counter_bits = static_cast<int>(random.between(20, 40));
    job.carriage.feed_pixels = ratio(random.count(1, 900), random.count(1, 9));
    job.carriage.layers = random.count(1, 5);
    const Plan plan = planned(job, 3000, job.carriage.layers);
    const AbPlan& ab = plan.carriage->ab;
    const Rational wanted =
        plan.line.rate_hz / plan.rotary.lines_per_revolution * plan.carriage->edges_per_revolution / 4;
    ASSERT_EQ(ab.wanted_hz, wanted);
    ASSERT_EQ(ab.output_hz, emitted_hz(ab, plan));
    const Rational relative = ab.output_hz / wanted - 1;
    ASSERT_EQ(ab.drift_um_per_revolution, relative * plan.carriage->feed_um);
    ASSERT_EQ(ab.exact, relative == 0);
    ASSERT_TRUE(plan.ab.exact || !job.fpga.fractional);
    ASSERT_EQ(ab.fraction_num, 0U);
    const Result<AbPair> best =
        best_ab_pair(increment_per_clock(wanted, ab.counter_bits, plan.clock.fpga_hz), ab.counter_bits,
                     job.fpga.max_prescaler, increment_per_clock(2'000'000, ab.counter_bits, plan.clock.fpga_hz));
    ASSERT_TRUE(best);
    ASSERT_EQ(ab.prescaler, best.value().prescaler);
    ASSERT_EQ(ab.increment, best.value().increment);
  }
}

TEST(HelicalPlan, TakesTheLineWhoseWorseAxisDriftsLeast) {
  Job job = helical_job();
  job.fpga.counter_bits = 22;
  job.fpga.max_prescaler = 50;
  const auto worse = [](const Plan& plan) {
    return std::max(abs(plan.ab.drift_um_per_revolution), abs(plan.carriage->ab.drift_um_per_revolution));
  };
  job.scanner.max_extra_slots = 40;
  const Plan chosen = planned(job, 3000, 8);
  Rational least = -1;
  std::int64_t best_slots = 0;
  job.scanner.max_extra_slots = 0;
  const std::int64_t turn = job.scanner.turn_slots;
  for (std::int64_t extra = 0; extra <= 40; ++extra) {
    job.scanner.turn_slots = turn + extra;
    const Plan plan = planned(job, 3000, 8);
    if (least < 0 || worse(plan) < least) {
      least = worse(plan);
      best_slots = plan.line.slots;
    }
  }
  EXPECT_EQ(chosen.line.slots, best_slots);
  EXPECT_EQ(worse(chosen), least);
}

TEST(FlatPlan, MakesThePassOfTheStage) {
  const Plan plan = planned(flat_job(), 3000, 4);
  EXPECT_EQ(plan.rotary.lines_per_revolution, 5000);
  EXPECT_EQ(plan.rotary.line_pitch_um, Rational(8));
  EXPECT_EQ(plan.rotary.circumference_um, Rational(40'000));
  EXPECT_EQ(plan.rotary.edges_per_revolution, Rational(40'000) / 20 * 1024);
  EXPECT_EQ(plan.rotary.surface_speed_mm_s, plan.line.rate_hz * 8 / 1000);
  EXPECT_EQ(plan.rotary.rpm, 0);
  EXPECT_EQ(plan.ab.output_hz, emitted_hz(plan.ab, plan));
  EXPECT_EQ(plan.job.revolutions, 4);
  EXPECT_FALSE(plan.bands || plan.carriage);
}

TEST(FlatPlan, ReachesTheLimitWithinAPassOrNever) {
  Job job = flat_job();
  job.fpga.counter_bits = 22;
  job.fpga.max_prescaler = 1;
  const Rational drift_um = abs(planned(job, 3000, 1000).ab.drift_um_per_revolution);
  ASSERT_GT(drift_um, 0);
  job.limits.seam_um = drift_um * 2;
  const Plan loose = planned(job, 3000, 1000);
  EXPECT_FALSE(loose.ab.lines_until_limit || loose.ab.revolutions_until_limit);
  EXPECT_TRUE(loose.warnings.empty()) << loose.warnings.front();
  job.limits.seam_um = drift_um / 2;
  const Plan tight = planned(job, 3000, 1000);
  EXPECT_EQ(tight.ab.lines_until_limit, Integer(2500));
  EXPECT_EQ(tight.ab.revolutions_until_limit, Integer(1));
  EXPECT_EQ(tight.warnings.size(), 1U);
}

TEST(Bands, AreAsFewAsFitAndButted) {
  for (const Mode mode : {Mode::rotary, Mode::flat}) {
    for (std::int64_t field = 1; field <= 40; ++field) {
      for (const std::int64_t columns : {1, 7, 39, 40, 41, 100}) {
        Job job = mode == Mode::flat ? flat_job() : roller_job();
        job.rotary.interpolation_bits = 7;                  // short lines, so it turns faster
        job.scanner.field_mm = ratio(8 * field + 7, 1000);  // the last 7 um hold no pixel
        const Plan plan = planned(job, columns, 3);
        ASSERT_EQ(image_columns(plan), columns);
        if (columns <= field) {
          ASSERT_FALSE(plan.bands);
          ASSERT_EQ(plan.line.pixels, columns);
          continue;
        }
        ASSERT_TRUE(plan.bands);
        ASSERT_EQ(plan.bands->count, (columns + field - 1) / field);
        ASSERT_LE(plan.line.pixels, field);
        ASSERT_LT((plan.bands->count - 1) * plan.line.pixels, columns) << "the last band shows something";
        ASSERT_GE(plan.bands->count * plan.line.pixels, columns);
        ASSERT_EQ(plan.job.revolutions, 3 * plan.bands->count);
        ASSERT_EQ(plan.bands->step_mm * 1000, plan.line.pixel_pitch_um * plan.line.pixels) << "band to band";
        ASSERT_EQ(revolutions_per_band(plan), 3);
      }
    }
  }
}

/// One value of a sound job changed, and all that is said of it.
struct ModeRefusal {
  std::string name;
  Mode mode;
  std::function<void(Job&)> change;
  ErrorCode code;
  std::string part;
  std::int64_t columns = 15'000;
  std::int64_t exposures = 8;
};

void PrintTo(const ModeRefusal& refusal, std::ostream* out) {
  *out << refusal.name;
}

const ModeRefusal kModeRefusals[] = {
    {"FeedOfZero", Mode::helical, [](Job& j) { j.carriage.feed_pixels = 0; }, ErrorCode::out_of_range,
     "carriage.feed_pixels = 0: must be greater than 0"},
    {"NoLayers", Mode::helical, [](Job& j) { j.carriage.layers = 0; }, ErrorCode::out_of_range,
     "carriage.layers = 0: must be 1 to"},
    {"OtherLayers", Mode::helical, [](Job& j) { j.carriage.layers = 7; }, ErrorCode::bad_argument,
     "carriage.layers = 7: there are 8 layers in [image], and one is needed for each: set carriage.layers = 8"},
    {"WindowWiderThanTheField", Mode::helical, [](Job& j) { j.scanner.field_mm = 4; }, ErrorCode::out_of_range,
     "carriage.feed_pixels = 64: a window of carriage.layers * feed_pixels = 512 columns does not fit scanner.field_mm "
     "= 4; at most 62.5 fit with these layers"},
    {"TooManyTurns", Mode::helical, [](Job& j) { j.carriage.feed_pixels = ratio(1, 100); }, ErrorCode::out_of_range,
     "carriage.feed_pixels = 0.01: the job takes 1500008 revolutions; at most 1000000 fit"},
    {"EndlessFeed", Mode::helical,
     [](Job& j) { j.carriage.feed_pixels = ratio((Integer(64) << 70) + 1, Integer(1) << 70); }, ErrorCode::out_of_range,
     "is a ratio beyond 62-bit integers; give it with fewer digits"},
    {"CarriagePitchOfZero", Mode::helical, [](Job& j) { j.carriage.encoder_pitch_um = 0; }, ErrorCode::out_of_range,
     "carriage.encoder_pitch_um = 0: must be greater than 0"},
    {"CarriageTooFast", Mode::helical, [](Job& j) { j.carriage.max_ab_hz = 100; }, ErrorCode::out_of_range,
     "carriage.interpolation_bits = 8: needs an A-B signal of 517.7157"},
    {"StageWithoutLines", Mode::flat, [](Job& j) { j.stage.lines = 0; }, ErrorCode::out_of_range,
     "stage.lines = 0: must be 1 to"},
    {"StagePitchOfZero", Mode::flat, [](Job& j) { j.stage.line_pitch_um = 0; }, ErrorCode::out_of_range,
     "stage.line_pitch_um = 0"},
    {"StageTooFast", Mode::flat, [](Job& j) { j.stage.max_ab_hz = 1000; }, ErrorCode::out_of_range,
     "a stage.encoder_pitch_um of at least "},
    {"StageTooLong", Mode::flat,
     [](Job& j) {
       j.stage.lines = 1'000'000'000;
       j.laser.pulse_divider = 65'535;
     },
     ErrorCode::out_of_range, "stage.lines = 1000000000: a pass takes ", 1'000'000},
    {"FieldOfNoPixel", Mode::flat, [](Job& j) { j.scanner.field_mm = ratio(7, 1000); }, ErrorCode::out_of_range,
     "scanner.field_mm = 0.007: holds no pixel of scanner.pixel_pitch_um = 8; at least 0.008 mm would"},
};

class ModeRefused : public testing::TestWithParam<ModeRefusal> {};

TEST_P(ModeRefused, SaysTheKeyTheValueAndWhatFits) {
  const ModeRefusal& refusal = GetParam();
  Job job = refusal.mode == Mode::flat ? flat_job() : helical_job();
  refusal.change(job);
  const Result<Plan> plan = make_plan(job, refusal.columns, refusal.exposures);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, refusal.code) << plan.error().message;
  EXPECT_NE(plan.error().message.find(refusal.part), std::string::npos) << plan.error().message;
  EXPECT_EQ(plan.error().message.find('\n'), std::string::npos) << plan.error().message;
}

INSTANTIATE_TEST_SUITE_P(Modes, ModeRefused, testing::ValuesIn(kModeRefusals),
                         [](const auto& its) { return its.param.name; });

TEST(ModeWarnings, NameTheAxisTheyAreAbout) {
  Job job = helical_job();
  job.carriage.encoder_pitch_um = 20'000;
  job.carriage.interpolation_bits = 0;
  job.fpga.counter_bits = 16;
  job.fpga.max_prescaler = 3;
  const Plan plan = planned(job, 15'000, 8);
  std::string all;
  for (const std::string& warning : plan.warnings) {
    all += warning + "\n";
  }
  EXPECT_NE(all.find("revolutions the carriage "), std::string::npos) << all;
  EXPECT_NE(all.find("too coarse to place single columns"), std::string::npos) << all;
}

}  // namespace
}  // namespace gravure
