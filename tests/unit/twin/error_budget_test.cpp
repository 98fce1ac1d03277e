#include "gravure/twin/error_budget.hpp"

#include <cmath>

#include "budget_support.hpp"
#include "twin_support.hpp"

namespace gravure::test {
namespace {

Result<ErrorBudget> budget_of(const SmallJob& small, const ErrorBudgetRequest& request) {
  return error_budget(
      [&]() -> Result<std::unique_ptr<LineSource>> {
        return std::unique_ptr<LineSource>(std::make_unique<MemorySource>(small.program));
      },
      request);
}

std::optional<double> of(const ErrorBudget& budget, ErrorTerm term) {
  return budget.budget_um[static_cast<std::size_t>(term)];
}

TwinSettings every_term() {
  TwinSettings twin;
  twin.servo = {true, 1000, ratio(7, 10)};
  twin.run_out = {true, 5, 30};
  twin.thermal = {true, 10, 12};
  return twin;
}

/// Every fired pulse by itself: largest and mean square, from the images.
TEST(ErrorBudget, SumsUpEveryFiredPulseWhicheverWayItsLineRuns) {
  SmallJob small;
  sound_job(small);  // 13 lines: every revolution starts the other way
  const Plan& plan = small.program.header.plan;
  const auto trajectory = trajectory_of(plan, roller_head());
  ErrorBudgetRequest request;
  request.twin = every_term();
  request.trajectory = &trajectory;
  const auto budget = budget_of(small, request);
  ASSERT_TRUE(budget) << budget.error().message;
  const ErrorModel model = model_of(plan, &trajectory, request.twin);
  double squares = 0;
  double most = 0;
  PulsePlace worst;
  std::int64_t pulses = 0;
  for (std::int64_t revolution = 0; revolution < 8; ++revolution) {
    for (std::int64_t line = 0; line < 13; ++line) {
      for (std::int64_t pixel = 0; pixel < 45; ++pixel) {
        if (!image_pixel(small.stack, small.images, revolution, line, pixel)) {
          continue;
        }
        const PulseError error = model.pulse_error(revolution, line, pixel);
        const double um = std::hypot(error.along_um, error.across_um);
        squares += um * um;
        ++pulses;
        if (um > most) {
          most = um;
          worst = {revolution, line,
                   line_is_reverse(plan, revolution, line) ? plan.line.reverse_first_slot + 44 - pixel
                                                           : plan.line.forward_first_slot + pixel};
        }
      }
    }
  }
  EXPECT_EQ(budget.value().simulated_revolutions, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(budget.value().simulated_pulses, pulses);
  EXPECT_NEAR(budget.value().rms_um, std::sqrt(squares / static_cast<double>(pulses)), 1e-9);
  EXPECT_NEAR(budget.value().simulated_max_um, most, 1e-9);
  EXPECT_EQ(budget.value().worst.revolution, worst.revolution);
  EXPECT_EQ(budget.value().worst.line, worst.line);
  EXPECT_EQ(budget.value().worst.slot, worst.slot);
  EXPECT_GE(budget.value().max_um, most);
  EXPECT_LE(budget.value().max_um, 2 * most);
}

TEST(ErrorBudget, DoesNotDependOnTheNumberOfThreads) {
  SmallJob small;
  sound_job(small);
  const auto trajectory = trajectory_of(small.program.header.plan, roller_head());
  ErrorBudgetRequest request;
  request.twin = every_term();
  request.trajectory = &trajectory;
  request.threads = 1;
  const auto one = budget_of(small, request);
  request.threads = 5;
  const auto five = budget_of(small, request);
  ASSERT_TRUE(one && five);
  EXPECT_EQ(one.value().rms_um, five.value().rms_um);
  EXPECT_EQ(one.value().simulated_max_um, five.value().simulated_max_um);
  EXPECT_EQ(one.value().worst.slot, five.value().worst.slot);
}

TEST(ErrorBudget, WithoutAScannerSaysWhatToAddAndGivesTheRest) {
  SmallJob small;
  sound_job(small);
  ErrorBudgetRequest request;
  request.twin = every_term();
  const auto budget = budget_of(small, request);
  ASSERT_TRUE(budget) << budget.error().message;
  for (const ErrorTerm term : {ErrorTerm::galvo_resolution, ErrorTerm::microvectors, ErrorTerm::cross_scan,
                               ErrorTerm::lag, ErrorTerm::defocus}) {
    EXPECT_FALSE(of(budget.value(), term)) << term_name(term);
  }
  EXPECT_EQ(of(budget.value(), ErrorTerm::drift), 0) << "exact with the second accumulator";
  EXPECT_GT(of(budget.value(), ErrorTerm::ab_step), 0);
  EXPECT_NEAR(*of(budget.value(), ErrorTerm::run_out), 5, 0.5);
  EXPECT_GT(of(budget.value(), ErrorTerm::servo), 0);
  EXPECT_NEAR(*of(budget.value(), ErrorTerm::thermal), 44 * 8 * 120e-6, 1e-9) << "the last column from the first";
  EXPECT_FALSE(budget.value().defocus_max_um);
  EXPECT_NE(all(budget.value().notes).find("give scanner.field_mm"), std::string::npos);
}

TEST(ErrorBudget, TermsThatAreOffAddNothing) {
  SmallJob small;
  sound_job(small);
  const auto trajectory = trajectory_of(small.program.header.plan, roller_head());
  ErrorBudgetRequest request;
  request.twin = no_terms();
  request.trajectory = &trajectory;
  const auto budget = budget_of(small, request);
  ASSERT_TRUE(budget) << budget.error().message;
  EXPECT_EQ(budget.value().max_um, 0);
  EXPECT_EQ(budget.value().rms_um, 0);
  for (const ErrorTerm term : kAllErrorTerms) {
    EXPECT_EQ(of(budget.value(), term), 0) << term_name(term);
  }
  EXPECT_FALSE(budget.value().defocus_max_um);
}

TEST(ErrorBudget, OfALongJobSimulatesTheFirstTheLastTheWorstAndSomeBetween) {
  SmallJob small;
  prepare(small, LinesAlong::rows, 13, 45, 3);
  small.job.fpga.fractional = false;  // drift grows until the last revolution
  compile_job(small, 1000, LayerOrder::cycle);
  ErrorBudgetRequest request;
  const auto budget = budget_of(small, request);
  ASSERT_TRUE(budget) << budget.error().message;
  const std::vector<std::int64_t>& chosen = budget.value().simulated_revolutions;
  EXPECT_EQ(chosen.size(), 12U);
  EXPECT_EQ(chosen.front(), 0);
  EXPECT_EQ(chosen.back(), 999);
  request.most_pulses = 100;  // less than a revolution has: some chunks of three
  const auto part = budget_of(small, request);
  ASSERT_TRUE(part) << part.error().message;
  EXPECT_LE(part.value().simulated_revolutions.size(), 3U);
  EXPECT_LT(part.value().simulated_pulses, budget.value().simulated_pulses / 4);
  EXPECT_GT(part.value().simulated_pulses, 0);
  EXPECT_EQ(part.value().max_um, budget.value().max_um);
}

TEST(ErrorBudget, StopsWhenCancelledAndPassesOnWhatCannotBeRead) {
  SmallJob small;
  sound_job(small);
  CancelToken cancel;
  cancel.cancel();
  ErrorBudgetRequest request;
  request.cancel = &cancel;
  const auto stopped = budget_of(small, request);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
  small.program.chunks.erase({3, 1});
  request.cancel = nullptr;
  const auto unread = budget_of(small, request);
  ASSERT_FALSE(unread);
  EXPECT_EQ(unread.error().code, ErrorCode::bad_file);
  small.program.header.plan.ab.prescaler = 0;
  EXPECT_EQ(budget_of(small, request).error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace gravure::test
