#include "axis_check.hpp"

#include <cmath>

#include "gravure/fpga/ab_edges.hpp"
#include "gravure/sync/drift.hpp"
#include "twin_support.hpp"

namespace gravure::test {
namespace {

/// A random job that can be planned.
Job random_axis_job(Dice& dice) {
  Job job = small_job(dice.between(1, 5000));
  job.laser.pulse_divider = dice.between(10, 60);
  job.fpga.clock_multiplier = dice.between(1, 3);
  job.fpga.counter_bits = static_cast<int>(dice.between(8, 64));
  job.fpga.fractional = dice.coin();
  job.fpga.max_prescaler = static_cast<std::uint64_t>(dice.between(1, 5000));
  job.scanner.bidirectional_offset_ticks = 0;
  job.rotary.encoder_lines = dice.between(1, 12'000);
  job.rotary.interpolation_bits = static_cast<int>(dice.between(0, 13));
  job.rotary.gear_encoder_turns = dice.between(1, 9);
  job.rotary.gear_workpiece_turns = dice.between(1, 9);
  return job;
}

/// Calls check(plan) for many random plans.
template <class Check>
void for_random_plans(Check&& check) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  int plans = 0;
  for (int trial = 0; trial < 2000 && plans < 150; ++trial) {
    const Result<Plan> plan = make_plan(random_axis_job(dice), dice.between(1, 4000), dice.between(1, 1000));
    if (plan) {
      ++plans;
      check(plan.value(), dice);
    }
    if (testing::Test::HasFatalFailure()) {
      return;
    }
  }
  EXPECT_GE(plans, 100) << "too few of the random jobs can be planned";
}

TEST(AxisCheck, ErrorIsDeviceMinusIdeal) {
  for_random_plans([](const Plan& plan, Dice& dice) {
    const AxisCheck check = AxisCheck::make(plan).value();
    for (int trial = 0; trial < 20; ++trial) {
      const std::int64_t lines = plan.job.revolutions * plan.rotary.lines_per_revolution;
      const std::int64_t ordinal = trial == 0 ? 0 : trial == 1 ? lines - 1 : dice.between(0, lines - 1);
      const Rational ideal = wanted_edges_at_line(plan, ordinal);
      const std::int64_t near = static_cast<std::int64_t>(floor_of(ideal)) + dice.between(0, 5);
      const Rational exact = Rational(Integer(near)) - ideal;
      const Rational at_end = Rational(Integer(near)) - wanted_edges_at_line(plan, ordinal + 1);
      ASSERT_EQ(check.exact_error_at_end(ordinal, near), at_end);
      ASSERT_NEAR(check.error_edges(ordinal, {.edges = near}), to_double(exact), 1e-14);
    }
  });
}

TEST(AxisCheck, TakesPitchesOfVeryManyDigits) {
  Job job = small_job(50);
  job.mode = Mode::flat;
  job.fpga.fractional = false;
  job.stage = {50, 8, ratio(Integer(5'618'393'465'650'583), Integer(1'000'000'000'000'000)), 9, 41'000'000, {}};
  const Result<Plan> plan = make_plan(job, 40, 1);
  ASSERT_TRUE(plan) << plan.error().message;
  const Result<AxisCheck> made = AxisCheck::make(plan.value());
  ASSERT_TRUE(made) << made.error().message;
  const Rational ideal = wanted_edges_at_line(plan.value(), 49);
  ASSERT_GT(denominator_of(ideal) + numerator_of(ideal), Integer(1) << 62U);
  const auto near = static_cast<std::int64_t>(floor_of(ideal)) + 3;
  EXPECT_NEAR(made.value().error_edges(49, {.edges = near}), to_double(Rational(Rational(Integer(near)) - ideal)),
              1e-12);
}

TEST(AxisCheck, DriftIsThatOfThePlan) {
  for_random_plans([](const Plan& plan, Dice&) {
    const AxisCheck check = AxisCheck::make(plan).value();
    ASSERT_EQ(check.drift_per_line() * plan.rotary.lines_per_revolution, plan.ab.drift_lines_per_revolution);
    ASSERT_EQ(check.step_um(), to_double(Rational(plan.rotary.circumference_um / plan.rotary.edges_per_revolution)));
    const std::int64_t lost = check.first_misplaced_line();
    if (lost < 0) {
      ASSERT_TRUE(check.drift_per_line() == 0 || abs(check.drift_per_line()) < ratio(1, Integer(1) << 63U));
      return;
    }
    ASSERT_GE(abs(Rational(check.drift_per_line() * lost)), ratio(1, 2));
    ASSERT_LT(abs(Rational(check.drift_per_line() * (lost - 1))), ratio(1, 2));
  });
}

TEST(AxisCheck, EdgesOfTheRegistersAreThoseOfTheModel) {
  for_random_plans([](const Plan& plan, Dice& dice) {
    const AxisCheck check = AxisCheck::make(plan).value();
    const fpga::AbRegisters registers{.bits = plan.ab.counter_bits,
                                      .prescaler = plan.ab.prescaler,
                                      .increment = plan.ab.increment,
                                      .fraction_num = plan.ab.fraction_num,
                                      .fraction_den = plan.ab.fraction_den};
    for (int trial = 0; trial < 50; ++trial) {
      const std::int64_t tick =
          dice.between(0, trial < 25 ? plan.job.ticks : std::numeric_limits<std::int64_t>::max() - 1);
      ASSERT_EQ(check.register_edges(tick), fpga::position_after(registers, static_cast<std::uint64_t>(tick)).edges);
    }
  });
}

/// The edges never lead the drift, and never lag by as much as the largest lag; close to it they do come.
TEST(AxisCheck, EdgesStayWithinOneLagOfTheDrift) {
  Rational closest = 0;
  for_random_plans([&](const Plan& plan, Dice& dice) {
    const AxisCheck check = AxisCheck::make(plan).value();
    for (int trial = 0; trial < 100; ++trial) {
      const std::int64_t ordinal = dice.between(0, plan.job.revolutions * plan.rotary.lines_per_revolution);
      const Rational lag =
          emitted_edges_at_line(plan, ordinal) - Rational(Integer(check.register_edges(ordinal * plan.line.ticks)));
      ASSERT_GE(lag, 0);
      ASSERT_LT(lag, check.largest_lag_edges());
      closest = std::max(closest, Rational(lag / check.largest_lag_edges()));
    }
  });
  EXPECT_GT(closest, ratio(9, 10)) << "the bound is to be near what happens";
}

TEST(AxisCheck, RefusesRegistersAndRatiosThatAreNone) {
  const Plan good = make_plan(small_job(13), 45, 3).value();
  const auto refused = [&](auto change) {
    Plan plan = good;
    change(plan);
    const Result<AxisCheck> check = AxisCheck::make(plan);
    return !check && check.error().code == ErrorCode::out_of_range;
  };
  EXPECT_TRUE(refused([](Plan& plan) { plan.ab.prescaler = 0; }));
  EXPECT_TRUE(refused([](Plan& plan) { plan.ab.fraction_den = 0; }));
  EXPECT_TRUE(refused([](Plan& plan) { plan.ab.counter_bits = 65; }));
  EXPECT_TRUE(refused([](Plan& plan) { plan.ab.counter_bits = 2; }));
  EXPECT_TRUE(refused([](Plan& plan) { plan.rotary.edges_per_revolution = 0; }));
  EXPECT_TRUE(refused([](Plan& plan) { plan.rotary.edges_per_revolution = ratio(-1, Integer(1) << 80U); }));
  EXPECT_FALSE(refused([](Plan&) {}));
}

}  // namespace
}  // namespace gravure::test
