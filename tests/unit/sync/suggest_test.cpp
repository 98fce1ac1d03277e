#include "gravure/sync/suggest.hpp"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "sync_support.hpp"

namespace gravure {
namespace {

using sync_test::planned;
using sync_test::Random;
using sync_test::roller_job;
using sync_test::seed_note;
using sync_test::tube_job;

constexpr std::int64_t kPixels = 1500;

std::vector<Suggestion> suggested(const Job& job, const SuggestTolerances& tolerances, std::int64_t pixels = kPixels) {
  Result<std::vector<Suggestion>> suggestions = suggest(job, pixels, 10, tolerances);
  EXPECT_TRUE(suggestions) << (suggestions ? "" : suggestions.error().message);
  return suggestions ? std::move(suggestions).value() : std::vector<Suggestion>{};
}

SuggestTolerances wide() {
  return {.lines_per_revolution = 5,
          .extra_slots = 300,
          .pitch_percent = Rational(100),
          .diameter_um = Rational(1'000'000),
          .most_suggestions = 10'000};
}

/// Setup 2 with nL = 942: the counts of exact tubes among 301 * 11.
Job tube_942() {
  Job job = tube_job();
  job.rotary.circumference_mm = ratio(942 * 6, 1000);
  job.rotary.max_ab_hz = 40'000'000;
  return job;
}

TEST(Suggest, FindsEveryExactTubeOfSetup2) {
  const std::pair<int, std::size_t> expected[] = {{0, 45}, {1, 21}, {2, 9}, {4, 4}, {8, 0}};
  for (const auto& [bits, count] : expected) {
    Job job = tube_942();
    job.rotary.interpolation_bits = bits;
    std::set<std::pair<std::int64_t, std::int64_t>> found;
    for (const Suggestion& suggestion : suggested(job, wide())) {
      found.emplace(suggestion.slots, suggestion.lines_per_revolution);
    }
    EXPECT_EQ(found.size(), count) << "q=" << bits;
  }
}

TEST(Suggest, NamesTheFirstExactTubeWithItsCosts) {
  SuggestTolerances tolerances = wide();
  tolerances.extra_slots = 0;
  const std::vector<Suggestion> all = suggested(tube_942(), tolerances);
  ASSERT_EQ(all.size(), 4U);  // nL = 940 with the pitch, then with the diameter giving way; then 944
  const Suggestion& by_pitch = all[0];
  EXPECT_EQ(by_pitch.slots, 1800);
  EXPECT_EQ(by_pitch.lines_per_revolution, 940);
  EXPECT_EQ(by_pitch.ab, (AbPair{.prescaler = 423, .increment = 335'544'320}));
  EXPECT_EQ(by_pitch.geometry, GeometryChange::pitch);
  EXPECT_EQ(by_pitch.line_pitch_um, ratio(942 * 6, 940));
  EXPECT_EQ(by_pitch.delta_line_pitch_um, ratio(12, 940));
  EXPECT_EQ(by_pitch.delta_diameter_um, 0);
  EXPECT_EQ(by_pitch.delta_line_time_us, 0);
  EXPECT_EQ(by_pitch.keys, (std::vector<JobKeyChange>{{"rotary.lines_per_revolution", "940"},
                                                      {"rotary.line_pitch_um", std::nullopt}}));
  const Suggestion& by_diameter = all[1];
  EXPECT_EQ(by_diameter.geometry, GeometryChange::diameter);
  EXPECT_EQ(by_diameter.delta_line_pitch_um, 0);
  EXPECT_EQ(by_diameter.delta_diameter_um, Rational(-12) / pi());
  EXPECT_EQ(by_diameter.keys, (std::vector<JobKeyChange>{{"rotary.circumference_mm", "5.64"}}));
}

/// Setup 1: none of 2107 candidates, nor of 165,249 with nL free within 1 %.
TEST(Suggest, FindsNothingForTheRollerOfSetup1) {
  SuggestTolerances tolerances = wide();
  tolerances.lines_per_revolution = 3;
  EXPECT_TRUE(suggested(roller_job(), tolerances, 3500).empty());
  tolerances.lines_per_revolution = 274;
  EXPECT_TRUE(suggested(roller_job(), tolerances, 3500).empty());
}

/// Every (np, nL) decided by planning that job: suggest() finds exactly the exact ones, nearest first.
TEST(Suggest, EqualsPlanningEveryCandidate) {
  SCOPED_TRACE(seed_note());
  Random random;
  std::size_t exact_jobs = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Job job = tube_job();
    job.laser.pulse_divider = std::int64_t{1} << random.between(3, 6);
    job.fpga.counter_bits = static_cast<int>(random.between(8, 64));
    job.fpga.max_prescaler = random.between(1, 3000);
    job.scanner.slots_per_microvector = random.count(1, 8);
    job.rotary.encoder_lines = 25 * (std::int64_t{1} << random.between(0, 8));
    job.rotary.gear_encoder_turns = random.count(1, 3);
    job.rotary.gear_workpiece_turns = random.count(1, 3);
    job.rotary.interpolation_bits = static_cast<int>(random.between(0, 3));
    job.rotary.circumference_mm.reset();
    job.rotary.diameter_mm = Rational(1);
    job.rotary.line_pitch_um.reset();
    job.rotary.lines_per_revolution = random.count(400, 700);
    SuggestTolerances tolerances = wide();
    tolerances.extra_slots = 60;
    std::set<std::pair<std::int64_t, std::int64_t>> found;
    for (const Suggestion& suggestion : suggested(job, tolerances)) {
      found.emplace(suggestion.slots, suggestion.lines_per_revolution);
    }
    const std::int64_t shortest = planned(job, kPixels, 10).line.slots;
    std::set<std::pair<std::int64_t, std::int64_t>> expected;
    for (std::int64_t slots = shortest; slots <= shortest + 60; slots += job.scanner.slots_per_microvector) {
      for (std::int64_t delta = -5; delta <= 5; ++delta) {
        Job candidate = job;
        candidate.scanner.turn_slots = slots - kPixels;
        candidate.rotary.lines_per_revolution = *job.rotary.lines_per_revolution + delta;
        const Result<Plan> plan = make_plan(candidate, kPixels, 10);
        if (plan && plan.value().ab.exact) {
          expected.emplace(slots, *candidate.rotary.lines_per_revolution);
        }
      }
    }
    EXPECT_EQ(found, expected);
    exact_jobs += expected.size();
  }
  EXPECT_GT(exact_jobs, 20U);
}

/// The keys are what the operator copies: applied to the job they must give the promised plan.
TEST(Suggest, GivesKeysThatMakeTheExactJob) {
  SCOPED_TRACE(seed_note());
  Random random;
  std::size_t checked = 0;
  for (int trial = 0; trial < 24; ++trial) {
    Job job = tube_942();
    job.scanner.slots_per_microvector = random.count(1, 5);
    job.rotary.interpolation_bits = static_cast<int>(random.between(0, 2));
    if (random.chance(2)) {
      job.rotary.circumference_mm.reset();
      job.rotary.diameter_mm = ratio(random.count(1790, 1810), 1000);
    }
    if (random.chance(2)) {
      job.rotary.line_pitch_um.reset();
      job.rotary.lines_per_revolution = 942;
    }
    const Plan before = planned(job, kPixels, 10);
    for (const Suggestion& suggestion : suggested(job, wide())) {
      const Plan after = planned(apply(job, suggestion), kPixels, 10);
      ++checked;
      EXPECT_TRUE(after.ab.exact);
      EXPECT_EQ(after.rotary.lines_per_revolution, suggestion.lines_per_revolution);
      EXPECT_EQ(after.line.slots, suggestion.slots);
      EXPECT_EQ((AbPair{.prescaler = after.ab.prescaler, .increment = after.ab.increment}), suggestion.ab);
      EXPECT_EQ(after.rotary.line_pitch_um, suggestion.line_pitch_um);
      EXPECT_EQ(after.rotary.line_pitch_um - before.rotary.line_pitch_um, suggestion.delta_line_pitch_um);
      EXPECT_EQ((after.rotary.circumference_um - before.rotary.circumference_um) / pi(), suggestion.delta_diameter_um);
      EXPECT_EQ(after.rotary.circumference_um / pi() / 1000, suggestion.diameter_mm);
      const Rational line_s = ratio(after.line.ticks - before.line.ticks, before.clock.fpga_hz);
      EXPECT_EQ(line_s * 1'000'000, suggestion.delta_line_time_us);
      EXPECT_EQ(ratio(after.line.ticks, before.line.ticks) * 100 - 100, suggestion.delta_line_time_percent);
    }
  }
  EXPECT_GT(checked, 200U);
}

TEST(Suggest, PutsTheLeastChangeFirst) {
  const std::vector<Suggestion> all = suggested(tube_942(), wide());
  ASSERT_GT(all.size(), 10U);
  const auto change = [](const Suggestion& suggestion) {
    return abs(ratio(suggestion.lines_per_revolution - 942, 942)) + ratio(suggestion.slots - 1800, 1800);
  };
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_LE(change(all[i - 1]), change(all[i]));
  }
  SuggestTolerances few = wide();
  few.most_suggestions = 7;
  const std::vector<Suggestion> first = suggested(tube_942(), few);
  ASSERT_EQ(first.size(), 7U);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].keys, all[i].keys);
  }
}

TEST(Suggest, KeepsTheTolerances) {
  SuggestTolerances tolerances = wide();
  tolerances.pitch_percent = ratio(1, 4);  // 942 +- 2 lines
  tolerances.diameter_um = Rational(6);    // 942 +- 3 lines of 6 um / pi
  std::set<std::int64_t> by_pitch;
  std::set<std::int64_t> by_diameter;
  for (const Suggestion& suggestion : suggested(tube_942(), tolerances)) {
    EXPECT_LE(abs(suggestion.delta_line_pitch_um), ratio(6, 400));
    EXPECT_LE(abs(suggestion.delta_diameter_um), 6);
    if (suggestion.geometry == GeometryChange::pitch) {
      by_pitch.insert(suggestion.lines_per_revolution);
    } else if (suggestion.geometry == GeometryChange::diameter) {
      by_diameter.insert(suggestion.lines_per_revolution);
    }
  }
  EXPECT_EQ(*by_pitch.begin(), 940);
  EXPECT_EQ(*by_pitch.rbegin(), 944);
  EXPECT_EQ(*by_diameter.begin(), 939);
  EXPECT_EQ(*by_diameter.rbegin(), 945);
  tolerances.pitch_percent = 0;
  tolerances.diameter_um = 0;
  for (const Suggestion& suggestion : suggested(tube_942(), tolerances)) {
    EXPECT_EQ(suggestion.geometry, GeometryChange::none);
    EXPECT_EQ(suggestion.lines_per_revolution, 942);
  }
}

TEST(Suggest, SaysNothingIsToBeChangedForAnExactJob) {
  Job job = tube_942();
  job.rotary.circumference_mm = ratio(940 * 6, 1000);
  const std::vector<Suggestion> all = suggested(job, wide());
  ASSERT_FALSE(all.empty());
  EXPECT_TRUE(all.front().keys.empty());
  EXPECT_EQ(all.front().geometry, GeometryChange::none);
}

TEST(Suggest, RefusesWhatItCannotLookThrough) {
  const auto refusal = [](const Job& job, const SuggestTolerances& tolerances) {
    const auto suggestions = suggest(job, kPixels, 10, tolerances);
    EXPECT_FALSE(suggestions);
    EXPECT_EQ(suggestions.error().code, ErrorCode::out_of_range);
    return suggestions.error().message;
  };
  SuggestTolerances tolerances = wide();
  tolerances.extra_slots = -1;
  EXPECT_NE(refusal(tube_job(), tolerances).find("tolerance extra_slots = -1: must be 0 to"), std::string::npos);
  tolerances = wide();
  tolerances.lines_per_revolution = -1;
  EXPECT_NE(refusal(tube_job(), tolerances).find("tolerance lines_per_revolution = -1"), std::string::npos);
  tolerances = wide();
  tolerances.pitch_percent = 101;
  EXPECT_NE(refusal(tube_job(), tolerances).find("tolerance pitch_percent = 101"), std::string::npos);
  tolerances = wide();
  tolerances.diameter_um = -1;
  EXPECT_NE(refusal(tube_job(), tolerances).find("tolerance diameter_um = -1"), std::string::npos);
  tolerances = wide();
  tolerances.extra_slots = 1'000'000'000;
  EXPECT_NE(refusal(tube_job(), tolerances).find("at most 100000000 are looked at"), std::string::npos);
  Job broken = tube_job();
  broken.rotary.encoder_lines = 0;
  EXPECT_NE(refusal(broken, wide()).find("rotary.encoder_lines = 0"), std::string::npos);
}

TEST(SuggestOutlook, NamesTheFinestInterpolationThatCloses) {
  Job job = tube_942();
  job.rotary.interpolation_bits = 8;
  EXPECT_TRUE(suggested(job, wide()).empty());
  const Result<SuggestOutlook> outlook = suggest_outlook(job, kPixels, 10, wide());
  ASSERT_TRUE(outlook) << outlook.error().message;
  ASSERT_TRUE(outlook.value().nearest.has_value());
  const int bits = *outlook.value().interpolation_bits;
  EXPECT_LT(bits, 8);
  for (int finer = bits + 1; finer < 8; ++finer) {
    job.rotary.interpolation_bits = finer;
    EXPECT_TRUE(suggested(job, wide()).empty()) << finer;
  }
  job.rotary.interpolation_bits = 8;
  const Plan plan = planned(apply(job, *outlook.value().nearest), kPixels, 10);
  EXPECT_TRUE(plan.ab.exact);
  EXPECT_EQ(plan.rotary.interpolation_bits, bits);
  ASSERT_TRUE(outlook.value().fraction.has_value());
  job.fpga.fractional = true;
  const Plan fractional = planned(job, kPixels, 10);
  EXPECT_EQ(fractional.ab.increment, outlook.value().fraction->increment);
  EXPECT_EQ(fractional.ab.fraction_num, outlook.value().fraction->num);
  EXPECT_EQ(fractional.ab.fraction_den, outlook.value().fraction->den);
}

TEST(SuggestOutlook, OffersTheFractionWhereNoInterpolationHelps) {
  Job job = tube_942();
  job.fpga.max_prescaler = 1;
  SuggestTolerances none;
  none.lines_per_revolution = 0;
  none.extra_slots = 0;
  const Result<SuggestOutlook> outlook = suggest_outlook(job, kPixels, 10, none);
  ASSERT_TRUE(outlook);
  EXPECT_FALSE(outlook.value().nearest.has_value());
  EXPECT_FALSE(outlook.value().interpolation_bits.has_value());
  EXPECT_TRUE(outlook.value().fraction.has_value());
}

}  // namespace
}  // namespace gravure
