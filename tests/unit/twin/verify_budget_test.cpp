#include <cmath>

#include "budget_support.hpp"
#include "gravure/scan/job_trajectory.hpp"
#include "judge_budget.hpp"
#include "twin_support.hpp"

/// Landing errors from the job through plan, program and device to the report.
namespace gravure::test {
namespace {

/// A tube with its scanner described: 130 lines of 46 pixels, 3 layers.
void scanner_job(SmallJob& small) {
  prepare(small, LinesAlong::rows, 130, 46, 3);  // as many dark slots before as after them
  small.job.scanner.field_mm = 12;
  small.job.scanner.resolution_bits = 16;
  small.job.scanner.bidirectional_offset_ticks = 0;
}

VerifyReport verified(SmallJob& small, const BudgetOptions& budget) {
  small.program = {};
  compile_job(small, 3, LayerOrder::sequence);
  VerifyOptions options;
  options.threads = 2;
  options.budget = budget;
  Result<VerifyReport> report = verify_job(small, small.lines(), options);
  EXPECT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report.value().error);
  return std::move(report).value();
}

double of(const VerifyReport& report, ErrorTerm term) {
  return report.error->budget_um[static_cast<std::size_t>(term)].value_or(-1);
}

constexpr double kCountUm = 12'000.0 / 65'536;

TEST(VerifyBudget, WithoutCorrectionFindsTheZigzagOfTheory) {
  SmallJob small;
  scanner_job(small);
  small.job.scanner.cross_scan_correction = false;
  const VerifyReport report = verified(small, {scanner_terms(), {}, {}});
  const LinePlan& line = small.program.header.plan.line;
  const double marking_s = 45 * 82 / 164e6;
  const double amplitude_um = to_double(small.program.header.plan.rotary.surface_speed_mm_s) * 1000 * marking_s / 2;
  EXPECT_NEAR(amplitude_um, 8.0 * 45 / static_cast<double>(line.slots) / 2, 1e-9) << "a part of the pitch";
  EXPECT_GT(amplitude_um, 5 * kCountUm) << "worth seeing";
  EXPECT_NEAR(of(report, ErrorTerm::cross_scan), amplitude_um, amplitude_um * 1e-2);
  EXPECT_NEAR(report.error->max_um, amplitude_um, kCountUm);
  EXPECT_NEAR(report.error->simulated_max_um, amplitude_um, kCountUm);
  EXPECT_TRUE(report.violations.empty()) << all(report.violations);
}

TEST(VerifyBudget, WithCorrectionTheScannerIsBelowItsResolution) {
  SmallJob small;
  scanner_job(small);
  const VerifyReport report = verified(small, {scanner_terms(), {}, {}});
  EXPECT_LT(report.error->max_um, kCountUm);
  EXPECT_GT(report.error->max_um, kCountUm / 10);
  EXPECT_GE(report.error->max_um, report.error->simulated_max_um);
  EXPECT_GE(report.error->simulated_max_um, report.error->rms_um);
}

TEST(VerifyBudget, TenMicrometresOfDiameterChangeThePitchAndLeaveTheSeamClosed) {
  SmallJob small;
  scanner_job(small);
  const VerifyReport before = verified(small, {TwinSettings{}, {}, {}});
  const Rational pitch_um = small.program.header.plan.rotary.line_pitch_um;
  *small.job.rotary.circumference_mm += pi() / 100;  // 10 um of diameter
  const VerifyReport after = verified(small, {TwinSettings{}, {}, {}});
  EXPECT_EQ(small.program.header.plan.rotary.line_pitch_um - pitch_um, pi() * 10 / 130);
  for (const VerifyReport* report : {&before, &after}) {
    EXPECT_EQ(report->seam_max_um, 0);
    EXPECT_EQ(of(*report, ErrorTerm::drift), 0);
    EXPECT_TRUE(report->violations.empty()) << all(report->violations);
  }
  // The same unknown to the job: the workpiece is warm.
  *small.job.rotary.circumference_mm -= pi() / 100;
  TwinSettings warm;
  const Rational diameter_mm = *small.job.rotary.circumference_mm / pi();
  warm.thermal = {true, 100, Rational(100) / diameter_mm};  // 100 K * 100 um/m/K a mm of diameter: 10 um
  const VerifyReport grown = verified(small, {warm, {}, {}});
  EXPECT_EQ(grown.seam_max_um, 0);
  EXPECT_NEAR(*grown.error->defocus_max_um, *before.error->defocus_max_um + 5, 5);
  EXPECT_GT(of(grown, ErrorTerm::thermal), 0);
}

TEST(VerifyBudget, UncompensatedLagDisplacesOddAgainstEvenLinesByTwiceSpeedTimesLag) {
  SmallJob small;
  scanner_job(small);
  small.job.scanner.lag_us = 3;
  small.job.scanner.compensate_lag = false;
  const VerifyReport late = verified(small, {TwinSettings{}, {}, {}});
  const double shift_um = to_double(small.program.header.plan.line.scan_speed_m_s) * 3;
  EXPECT_NEAR(shift_um, 48, 1e-9);
  EXPECT_NEAR(of(late, ErrorTerm::lag), shift_um, 2)
      << "each way, and the first pulses while the mirrors still turn: 96 um between odd and even lines";
  EXPECT_NEAR(late.error->rms_um, shift_um, 1);
  small.job.scanner.bidirectional_offset_ticks = 6 * 164;  // reverse pulses 6 us later: all lines displaced alike
  small.job.scanner.turn_slots = 60;
  const VerifyReport even = verified(small, {TwinSettings{}, {}, {}});
  EXPECT_NEAR(of(even, ErrorTerm::lag), shift_um, 2);
  small.job.scanner.bidirectional_offset_ticks = 0;
  small.job.scanner.compensate_lag = true;
  EXPECT_LT(of(verified(small, {TwinSettings{}, {}, {}}), ErrorTerm::lag), 1e-6);
}

TEST(VerifyBudget, LimitsAreJudgedAndTheLargestTermIsNamed) {
  SmallJob small;
  scanner_job(small);
  small.job.scanner.lag_us = 3;
  small.job.scanner.compensate_lag = false;
  const VerifyReport bad = verified(small, {TwinSettings{}, Rational(20), ratio(1, 1000)});
  expect_violation(bad, "um from its target, which exceeds limits.landing_um = 20: the largest term is lag");
  expect_violation(bad, "um from focus, which exceeds limits.defocus_um = 0.001");
  const VerifyReport good = verified(small, {TwinSettings{}, Rational(200), Rational(100)});
  EXPECT_TRUE(good.violations.empty()) << all(good.violations);
}

TEST(VerifyBudget, LimitsThatCannotBeJudgedAreNotKept) {
  SmallJob small;
  scanner_job(small);
  small.job.scanner.field_mm.reset();
  const VerifyReport blind = verified(small, {TwinSettings{}, Rational(20), Rational(20)});
  expect_violation(blind, "limits.landing_um cannot be judged without the scanner: give scanner.field_mm");
  expect_violation(blind, "limits.defocus_um cannot be judged: give scanner.field_mm");
  EXPECT_NE(all(blind.notes).find("give scanner.field_mm"), std::string::npos);
  EXPECT_TRUE(verified(small, {TwinSettings{}, {}, {}}).violations.empty());
}

TEST(VerifyBudget, OneSetPointThatIsNotThePlansIsAViolation) {
  SmallJob small;
  scanner_job(small);
  compile_job(small, 3, LayerOrder::sequence);
  const auto trajectory = scan::JobTrajectory::make(small.program.header.plan);
  ASSERT_TRUE(trajectory) << trajectory.error().message;
  const std::vector<LineSetPoints> planned = trajectory.value().stored_set_points();
  ASSERT_EQ(planned.size(), 2U);
  const auto violations_of = [&small](const std::vector<LineSetPoints>& stored) {
    small.program.header.set_points = stored;
    const Result<VerifyReport> report = verify_job(small, small.lines());
    EXPECT_TRUE(report) << report.error().message;
    return all(report.value().violations);
  };
  EXPECT_EQ(violations_of(planned), "");
  EXPECT_EQ(violations_of({}), "") << "an older program";
  for (const std::size_t row : {std::size_t{0}, std::size_t{1}}) {
    for (const std::size_t k : {std::size_t{0}, planned[row].u_counts.size() - 1}) {
      std::vector<LineSetPoints> stored = planned;
      ++stored[row].v_counts[k];
      EXPECT_EQ(violations_of(stored), "the scanner's orders are not those of the plan: set-point " +
                                           std::to_string(k) + " of " + (row == 0 ? "forward" : "reverse") +
                                           " lines is stored as V = " + std::to_string(stored[row].v_counts[k]) +
                                           " counts, its plan gives " + std::to_string(planned[row].v_counts[k]) +
                                           ": compile the job again\n");
      stored = planned;
      stored[row].u_counts[k] = 2147483647;
      EXPECT_NE(violations_of(stored), "");
      stored[row].u_counts = planned[row].u_counts;
      stored[row].u_counts.pop_back();
      EXPECT_NE(violations_of(stored), "") << "one is missing";
    }
  }
  EXPECT_NE(violations_of({planned[0]}), "") << "a kind of line is missing";
}

TEST(VerifyBudget, ASimulatedPulseBeyondTheBoundIsAViolation) {
  ErrorBudget budget;
  budget.max_um = budget.simulated_max_um = 2.5;
  budget.worst = {3, 7, 11};
  VerifyReport report;
  judge_bound(budget, report);
  EXPECT_TRUE(report.violations.empty());
  budget.simulated_max_um = 2.501;
  judge_bound(budget, report);
  expect_violation(report, "revolution 3, line 7, slot 11 lands 2.501 um from its target, beyond the bound of 2.5 um");
}

TEST(VerifyBudget, LinesTheScannerCannotFollowAreAViolation) {
  SmallJob small;
  scanner_job(small);
  small.job.scanner.turn_slots = 0;
  compile_job(small, 3, LayerOrder::sequence);
  const Result<VerifyReport> report = verify_job(small, small.lines(), {.budget = BudgetOptions{}});
  ASSERT_TRUE(report) << report.error().message;
  expect_violation(report.value(), "the scanner has no path for these lines: scan: ");
  EXPECT_EQ(all(report.value().notes).find("give scanner.field_mm"), std::string::npos) << "it is given";
}

}  // namespace
}  // namespace gravure::test
