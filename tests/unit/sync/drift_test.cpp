#include "gravure/sync/drift.hpp"

#include <gtest/gtest.h>

#include "sync_support.hpp"

namespace gravure {
namespace {

using sync_test::planned;
using sync_test::roller_job;

TEST(Drift, IsTheDifferenceOfEmittedAndWantedEdges) {
  const Plan plan = planned(roller_job(), 3500, 100);
  for (const std::int64_t line : {std::int64_t{0}, std::int64_t{1}, std::int64_t{27'489}, std::int64_t{5'910'135}}) {
    const Rational edges = emitted_edges_at_line(plan, line) - wanted_edges_at_line(plan, line);
    const Rational lines = edges / plan.rotary.edges_per_revolution * Rational(plan.rotary.lines_per_revolution);
    EXPECT_EQ(drift_lines_after(plan, line), lines);
    EXPECT_EQ(drift_um_after(plan, line), lines * plan.rotary.line_pitch_um);
  }
}

TEST(Drift, OfOneLineIsTheRelativeError) {
  const Plan plan = planned(roller_job(), 3500, 100);
  EXPECT_EQ(to_string(drift_lines_after(plan, 1)), "17820343/208291482765885440");
}

/// Counts of the counter, from the registers alone: what has been emitted by the tick at which a line starts.
TEST(Drift, FollowsFromTheRegisters) {
  const Plan plan = planned(roller_job(), 3500, 100);
  const Integer line = 123'456;
  const Rational counts = Rational(line * plan.line.ticks) * ratio(plan.ab.increment, plan.ab.prescaler);
  EXPECT_EQ(emitted_edges_at_line(plan, line), counts / Rational(Integer(1) << 30U));
}

TEST(Drift, WantsWholeTurnsAtWholeRevolutions) {
  const Plan plan = planned(roller_job(), 3500, 100);
  EXPECT_EQ(wanted_turns_at_line(plan, 0), 0);
  EXPECT_EQ(wanted_turns_at_line(plan, Integer(27'489) * 3), 3);
  EXPECT_EQ(wanted_edges_at_line(plan, 27'489), plan.rotary.edges_per_revolution);
}

TEST(Seam, AddsUpOverRevolutions) {
  const Plan plan = planned(roller_job(), 3500, 100);
  const Seam first = seam_after_revolution(plan, 0);
  const Seam last = seam_after_revolution(plan, 99);
  EXPECT_EQ(first.step_um, plan.ab.drift_um_per_revolution);
  EXPECT_EQ(first.accumulated_um, first.step_um);
  EXPECT_EQ(first.accumulated_lines, plan.ab.drift_lines_per_revolution);
  EXPECT_EQ(last.step_um, first.step_um);
  EXPECT_EQ(last.accumulated_um, first.step_um * 100);
  EXPECT_EQ(last.accumulated_um, drift_um_after(plan, Integer(27'489) * 100));
}

TEST(Seam, IsZeroForEverWithTheFraction) {
  Job job = roller_job();
  job.fpga.fractional = true;
  const Plan plan = planned(job, 3500, 100);
  EXPECT_EQ(seam_after_revolution(plan, Integer(1) << 100U).accumulated_um, 0);
}

}  // namespace
}  // namespace gravure
