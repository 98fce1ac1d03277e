#include "gravure/core/board_runs.hpp"

#include <gtest/gtest.h>

namespace gravure::test {
namespace {

Plan plan_of(Mode mode, std::int64_t revolutions, std::int64_t bands) {
  Plan plan;
  plan.mode = mode;
  plan.clock = {.seed_hz = 1000, .fpga_hz = 2000, .pulse_divider = 3, .pulse_hz = 1, .ticks_per_slot = 6};
  plan.line.pixels = 10;
  plan.line.slots = 20;
  plan.line.ticks = 120;
  plan.rotary.lines_per_revolution = 7;
  plan.rotary.ticks_per_revolution = 840;
  if (bands > 1) {
    plan.bands = BandsPlan{.count = bands, .columns = 10 * bands, .revolutions_per_band = revolutions, .step_mm = 12};
  }
  plan.job.revolutions = revolutions * bands;
  plan.job.ticks = plan.job.revolutions * 840;
  return plan;
}

/// Whatever the mode: no revolution is left out or comes twice, and times and places follow from that.
void expect_whole(const Plan& plan) {
  std::int64_t next = 0;
  for (const BoardRun& run : runs_of(plan)) {
    EXPECT_EQ(run.first_revolution, next);
    EXPECT_EQ(run.first_tick, next * 840);
    EXPECT_EQ(run.ticks, run.revolutions * 840);
    for (std::int64_t r = next; r < run.end_revolution(); ++r) {
      const BoardRun again = run_with(plan, r);
      EXPECT_EQ(again.first_revolution, run.first_revolution);
      EXPECT_EQ(again.backward, run.backward);
      EXPECT_EQ(again.axial_mm, run.axial_mm);
    }
    next = run.end_revolution();
  }
  EXPECT_EQ(next, plan.job.revolutions);
}

TEST(BoardRuns, AreTheBandsOfARotaryJob) {
  const Plan plan = plan_of(Mode::rotary, 4, 3);
  expect_whole(plan);
  const std::vector<BoardRun> runs = runs_of(plan);
  ASSERT_EQ(runs.size(), 3U);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    EXPECT_EQ(runs[i].revolutions, 4);
    EXPECT_FALSE(runs[i].backward);
    EXPECT_EQ(runs[i].band, static_cast<std::int64_t>(i));
    EXPECT_EQ(runs[i].axial_mm, Rational(12 * static_cast<int>(i)));
  }
}

TEST(BoardRuns, AreOneWhereNothingStopsTheAxis) {
  for (const Mode mode : {Mode::rotary, Mode::helical}) {
    const Plan plan = plan_of(mode, 5, 1);
    expect_whole(plan);
    EXPECT_EQ(runs_of(plan).size(), 1U);
  }
}

TEST(BoardRuns, AreThePassesOfAFlatJobToAndFro) {
  const Plan plan = plan_of(Mode::flat, 3, 2);
  expect_whole(plan);
  const std::vector<BoardRun> runs = runs_of(plan);
  ASSERT_EQ(runs.size(), 6U);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    EXPECT_EQ(runs[i].backward, i % 2 == 1) << "pass " << i;
    EXPECT_EQ(runs[i].axial_mm, Rational(i < 3 ? 0 : 12));
  }
}

TEST(BoardRuns, GiveTheSetupOfTheRunThatHasTheLine) {
  Plan plan = plan_of(Mode::flat, 3, 2);
  plan.spin.emplace();
  plan.spin->up.segments = {{3, 5}, {4, 6}};
  plan.spin->down.segments = {{2, 7}};
  const DeviceSetup back = device_setup(plan, 3, 2);
  EXPECT_TRUE(back.backward);
  EXPECT_EQ(back.begin_revolution, 3);
  EXPECT_EQ(back.end_revolution, 4);
  EXPECT_EQ(back.first_revolution, 3);
  EXPECT_EQ(back.first_line, 2);
  ASSERT_EQ(back.spin_up.size(), 2U);
  EXPECT_EQ(back.spin_up[1].increment, 4U);
  ASSERT_EQ(back.spin_down.size(), 1U);
  EXPECT_EQ(back.spin_down[0].seeds, 7U);
  const DeviceSetup band = device_setup(plan_of(Mode::rotary, 4, 3), 6, 1);
  EXPECT_FALSE(band.backward);
  EXPECT_EQ(band.begin_revolution, 4);
  EXPECT_EQ(band.end_revolution, 8);
  EXPECT_EQ(band.first_revolution, 6);
}

}  // namespace
}  // namespace gravure::test
