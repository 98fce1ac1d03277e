#include "worst_case.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "gravure/motion/shaper.hpp"
#include "indexing_models.hpp"
#include "worst_case_moves.hpp"

namespace gravure::motion {
namespace {

double exit_s(const SearchProblem& problem, const std::vector<InputJump>& input, const std::vector<Mode>& modes,
              double narrower = 0) {
  return residual_of(modes, input, problem.band.of).last_exit_s(problem.band.tolerance * (1 - narrower));
}

// Seen in the field: 205.2 ms at the corners and the middle, while a ripple's peak enters the band at +3.68 % only.
TEST(WorstCase, FindsAPeakThatTouchesTheBandBetweenTheCorners) {
  const SearchProblem problem{
      28, 200, 5000, 5000, 1e21, 250, {{25.839563404858502, 0.036036638748262045, 1}}, {BandOf::acceleration, 800}, 5};
  const auto input = input_of(plan_profile(SFactorRequest{{28, 200, 5000, 5000, 0, 0}, 0, 250}).value());
  const std::vector<Mode> off{{problem.modes[0].f_hz * 1.0368, problem.modes[0].zeta * 0.95, 1}};
  const WorstCase worst = worst_case(problem, input);
  EXPECT_GE(worst.after_s, exit_s(problem, input, off));
  ASSERT_EQ(worst.modes.size(), 1U);
  EXPECT_NEAR(worst.after_s, exit_s(problem, input, worst.modes, 1e-3), 2e-4);
}

TEST(WorstCase, IsNeverBelowAndHardlyAboveAnyErrorsOfTwoModes) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  int reached = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const test::ErringMove move = test::random_erring_move(random, 2);
    const double error = move.problem.mode_error_percent / 100;
    const WorstCase worst = worst_case(move.problem, move.input);
    for (int draw = 0; draw < 3000; ++draw) {
      std::vector<Mode> modes = move.problem.modes;
      for (Mode& mode : modes) {  // half of the draws on the sides, where the worst is
        mode.f_hz *= 1 + error * random.between(-1, 1);
        const double side = draw % 2 == 0 ? std::copysign(1.0, random.between(-1, 1)) : random.between(-1, 1);
        mode.zeta = std::min(0.999, mode.zeta * (1 + error * side));
      }
      ASSERT_LE(exit_s(move.problem, move.input, modes), worst.after_s * (1 + 1e-12)) << trial;
    }
    // Its own witness, between nodes, comes close.
    ASSERT_EQ(worst.modes.size(), 2U);
    reached += exit_s(move.problem, move.input, worst.modes, 0.02) >= worst.after_s * (1 - 1e-9) ? 1 : 0;
  }
  EXPECT_GT(reached, 140);
}

TEST(WorstCase, IsTheExactTimeWithoutErrorsAndNearlySoWithTinyOnes) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  for (int trial = 0; trial < 200; ++trial) {
    test::ErringMove move = test::random_erring_move(random, 2);
    move.problem.mode_error_percent = 0;
    const double exact = exit_s(move.problem, move.input, move.problem.modes);
    EXPECT_EQ(worst_case(move.problem, move.input).after_s, exact);
    move.problem.mode_error_percent = 1e-6;
    const double nearly = worst_case(move.problem, move.input).after_s;
    EXPECT_GE(nearly, exact * (1 - 1e-12)) << trial;
    EXPECT_LE(nearly, exit_s(move.problem, move.input, move.problem.modes, 1e-3) * (1 + 1e-9)) << trial;
  }
}

TEST(WorstCase, EndsForModesThatHardlyOrNeverDecayAndForShapedMoves) {
  const auto input = input_of(plan_profile(test::indexing(500, 30000, 30000, 22)).value());
  for (const double zeta : {0.0, 1e-12, 1e-9, 1e-6, 1e-4, 0.9999}) {
    SearchProblem problem{20, 500, 30000, 30000, 1e21, 250, {{36, 0.2, 1.2}, {87, zeta, -0.2}}, test::kPublishedBand,
                          5};
    const double worst = worst_case(problem, input).after_s;
    EXPECT_GE(worst, exit_s(problem, input, problem.modes)) << zeta;
    EXPECT_EQ(worst == std::numeric_limits<double>::infinity(), zeta == 0) << zeta;
    problem.modes[1].zeta = std::min(0.99, std::max(zeta, 1e-3));
    const auto shaped = shape_input(input, make_shaper(ShaperKind::zvd, problem.modes).value());
    EXPECT_GE(worst_case(problem, shaped).after_s, exit_s(problem, shaped, problem.modes)) << zeta;
  }
}

}  // namespace
}  // namespace gravure::motion
