#include "error_model.hpp"

#include <cmath>

#include "axis_check.hpp"
#include "budget_support.hpp"
#include "dice.hpp"
#include "gravure/core/exact.hpp"
#include "gravure/core/spin_phase.hpp"

namespace gravure::test {
namespace {

double magnitude(const PulseError& error) {
  return std::hypot(error.along_um, error.across_um);
}

TEST(ErrorModel, WithoutCorrectionLinesZigzagByHalfTheWayTheSurfaceMoves) {
  const Plan plan = plan_of(roller_job(), 3500, 2);
  const auto off = trajectory_of(plan, roller_head(), {false, true, {}});
  TwinSettings twin = no_terms();
  twin.cross_scan = true;
  const ErrorModel model = model_of(plan, &off, twin);
  const double slot_s = 82 / 164e6;
  const double amplitude_um = to_double(plan.rotary.surface_speed_mm_s) * 3499 * slot_s / 2 * 1000;
  EXPECT_NEAR(amplitude_um, 2.59, 0.01) << "a third of the pitch";
  EXPECT_NEAR(model.job_bound().bound.landing_um, amplitude_um, 1e-6);
  // The surface has not come as far as the target at the begin of a line, and is beyond at its end.
  EXPECT_NEAR(model.pulse_error(0, 0, 0).across_um, amplitude_um, 1e-6);
  EXPECT_NEAR(model.pulse_error(0, 0, 3499).across_um, -amplitude_um, 1e-6);
  EXPECT_NEAR(model.pulse_error(0, 1, 0).across_um, -amplitude_um, 1e-6) << "the other way: it ends here";
  EXPECT_NEAR(model.pulse_error(0, 1, 3499).across_um, amplitude_um, 1e-6);
  EXPECT_NEAR(model.pulse_error(0, 1, 3499).along_um, 0, 1e-6);
}

TEST(ErrorModel, WithCorrectionTheScannerIsBelowItsResolution) {
  const Plan plan = plan_of(roller_job(), 3500, 2);
  const auto on = trajectory_of(plan, roller_head());
  const ErrorModel model = model_of(plan, &on, scanner_terms());
  EXPECT_LT(model.job_bound().bound.landing_um, kRollerCountUm);
  EXPECT_GT(model.job_bound().bound.landing_um, kRollerCountUm / 4);
  TwinSettings alone = no_terms();
  alone.cross_scan = true;
  EXPECT_LT(model_of(plan, &on, alone).job_bound().bound.landing_um, 1e-6);
}

TEST(ErrorModel, LagDisplacesOddAgainstEvenLinesByTwiceSpeedTimesLag) {
  const Plan plan = plan_of(roller_job(), 3500, 2);
  kinematics::ScanHead head = roller_head();
  head.lag_us = 3;
  const auto late = trajectory_of(plan, head, {true, false, {}});
  TwinSettings twin = no_terms();
  twin.lag = true;
  const ErrorModel model = model_of(plan, &late, twin);
  const double shift_um = 16'000 * 3e-6 * 1000;
  EXPECT_NEAR(model.pulse_error(0, 0, 1750).along_um, shift_um, 1e-3) << "short of its target";
  EXPECT_NEAR(model.pulse_error(0, 0, 1750).along_um - model.pulse_error(0, 1, 1750).along_um, 2 * shift_um, 1e-3);
  const auto early = trajectory_of(plan, head);
  EXPECT_LT(model_of(plan, &early, twin).job_bound().bound.landing_um, 1e-6) << "compensated: 492 whole ticks";
}

TEST(ErrorModel, DelayedReversePulsesBelongToTheLagTheyMakeUpFor) {
  Job job = roller_job();
  job.scanner.bidirectional_offset_ticks = 12 * 82;  // 6 us
  const Plan plan = plan_of(job, 3500, 2);
  kinematics::ScanHead head = roller_head();
  head.lag_us = 3;
  const auto late = trajectory_of(plan, head, {true, false, {}});
  TwinSettings twin = no_terms();
  twin.lag = true;
  const ErrorModel model = model_of(plan, &late, twin);
  EXPECT_NEAR(model.pulse_error(0, 0, 1000).along_um, model.pulse_error(0, 1, 1000).along_um, 1e-3);
  twin.lag = false;
  EXPECT_EQ(magnitude(model_of(plan, &late, twin).pulse_error(0, 1, 1000)), 0);
}

TEST(ErrorModel, AxisIsWhereTheEdgesOfTheRegistersPutIt) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  int plans = 0;
  for (int trial = 0; trial < 100; ++trial) {
    Job job = small_job(dice.between(2, 40));
    job.fpga.fractional = dice.coin();
    job.fpga.counter_bits = static_cast<int>(dice.between(16, 64));
    job.rotary.encoder_lines = dice.between(100, 9000);
    const Result<Plan> made = make_plan(job, dice.between(2, 50), dice.between(1, 20));
    if (!made) {
      continue;
    }
    ++plans;
    const Plan& plan = made.value();
    TwinSettings twin = no_terms();
    twin.drift = twin.ab_step = true;
    const ErrorModel model = model_of(plan, nullptr, twin);
    const AxisCheck check = AxisCheck::make(plan).value();
    for (int pulse = 0; pulse < 20; ++pulse) {
      const std::int64_t revolution = dice.between(0, plan.job.revolutions - 1);
      const std::int64_t line = dice.between(0, plan.rotary.lines_per_revolution - 1);
      const std::int64_t pixel = dice.between(0, plan.line.pixels - 1);
      const bool reverse = line_is_reverse(plan, revolution, line);
      const std::int64_t slot =
          reverse ? plan.line.reverse_first_slot + plan.line.pixels - 1 - pixel : plan.line.forward_first_slot + pixel;
      const std::int64_t tick = (revolution * plan.rotary.lines_per_revolution + line) * plan.line.ticks +
                                slot * plan.clock.ticks_per_slot + (reverse ? plan.line.offset_remainder_ticks : 0);
      const Rational ideal =
          plan.rotary.edges_per_revolution * ratio(tick, plan.line.ticks) / plan.rotary.lines_per_revolution;
      const Rational leads = Rational(Integer(check.register_edges(tick))) - ideal;
      const PulseError error = model.pulse_error(revolution, line, pixel);
      ASSERT_NEAR(error.across_um, -to_double(leads) * check.step_um(), 1e-9 + 1e-9 * check.step_um());
      ASSERT_EQ(error.along_um, 0);
    }
  }
  EXPECT_GE(plans, 50);
}

TEST(ErrorModel, DriftAloneIsThatOfThePlanAtTheEndOfTheJob) {
  Job job = roller_job();
  job.fpga.fractional = false;
  const Plan plan = plan_of(job, 3500, 100);
  TwinSettings twin = no_terms();
  twin.drift = true;
  const double um = std::abs(to_double(plan.ab.drift_um_per_revolution)) * 100;
  EXPECT_GT(um, 0);
  const double bound = model_of(plan, nullptr, twin).job_bound().bound.landing_um;
  EXPECT_LE(bound, um);
  EXPECT_GT(bound, um * (1 - 1e-6)) << "but for the turn after the last pulse";
}

TEST(ErrorModel, ServoAloneIsItsFollowingErrorOnTheSurface) {
  const Plan plan = plan_of(roller_job(), 3500, 2);
  TwinSettings twin = no_terms();
  twin.servo = {true, 50, ratio(7, 10)};
  const ErrorModel model = model_of(plan, nullptr, twin);
  const double um = 2 * 0.7 * to_double(plan.rotary.surface_speed_mm_s) * 1000 / (2 * kPi * 50);
  EXPECT_NEAR(model.job_bound().bound.landing_um, um, um * 1e-9);
  EXPECT_NEAR(model.pulse_error(1, 7, 100).across_um, um, um * 1e-9) << "behind: it lands before its target";
  twin.ab_step = true;
  const ErrorModel smooth = model_of(plan, nullptr, twin);
  const double step_um = to_double(Rational(plan.rotary.circumference_um / plan.rotary.edges_per_revolution));
  const double edges_per_tick = to_double(plan.ab.output_hz) * 4 / 164e6;
  EXPECT_NEAR(smooth.pulse_error(1, 7, 100).across_um, um + step_um * (1 + edges_per_tick) / 2, step_um * 1e-3)
      << "the edges are beyond its bandwidth: half a step remains of them, and half the tick that each waits for";
}

TEST(ErrorModel, RunOutMovesPlacesRoundTheWorkpieceAndLiftsThem) {
  const Plan plan = plan_of(roller_job(), 3500, 2);
  const auto trajectory = trajectory_of(plan, roller_head());
  TwinSettings twin = no_terms();
  twin.run_out = {true, 30, 90};
  const ErrorModel model = model_of(plan, &trajectory, twin);
  const double radius_um = to_double(plan.rotary.circumference_um) / (2 * kPi);
  double turned_um = 0;
  for (std::int64_t line = 0; line < 27'489; line += 1009) {
    const double theta = 2 * kPi * static_cast<double>(line) / 27'489 - kPi / 2;
    // A beam to the axis of rotation meets the workpiece at this angle of its own, beyond the one it should.
    turned_um = radius_um * std::asin(30 / radius_um * std::sin(theta));
    const double height_um =
        30 * std::cos(theta) + std::sqrt(radius_um * radius_um - std::pow(30 * std::sin(theta), 2)) - radius_um;
    const PulseError error = model.pulse_error(0, line, 1750);
    ASSERT_NEAR(error.across_um, -turned_um, 2e-3) << line;
    ASSERT_NEAR(error.defocus_um, height_um, 0.02) << line;
    ASSERT_NEAR(error.along_um, 0, 1e-9);
  }
  EXPECT_NEAR(model.job_bound().bound.landing_um, 30, 2e-3);
  EXPECT_NEAR(model.job_bound().bound.defocus_um, 30, 0.01);
}

TEST(ErrorModel, RunOutUnderSlantingLightIsThatOfTheCircle) {
  Job job = small_job(400);  // a tube of 0.7 mm
  job.rotary.circumference_mm.reset();
  job.rotary.diameter_mm = ratio(7, 10);
  job.scanner.bidirectional_offset_ticks = 0;
  const Plan plan = plan_of(job, 40, 2);
  const double radius_um = 350;
  for (const double offset_deg : {0.0, 45.0, 80.0}) {
    const auto trajectory = trajectory_of(plan, roller_head(), {}, offset_deg);
    TwinSettings twin = no_terms();
    for (const int eccentricity_um : {3, 50}) {
      twin.run_out = {true, eccentricity_um, 17};
      const double offset = offset_deg * kPi / 180;
      const double beam_um = radius_um * std::sin(offset);
      const Result<ErrorModel> made = ErrorModel::make(plan, &trajectory, twin);
      if (beam_um + eccentricity_um >= radius_um) {
        ASSERT_FALSE(made);
        EXPECT_EQ(made.error().code, ErrorCode::out_of_range) << made.error().message;
        continue;
      }
      ASSERT_TRUE(made) << made.error().message;
      const double worst = radius_um * std::abs(std::asin((beam_um + eccentricity_um) / radius_um) - offset);
      double most = 0;
      for (std::int64_t line = 0; line < 400; ++line) {
        // Seen along the axis: it has gone round with the workpiece, and the beam is where it was.
        const double from_high_spot = 2 * kPi * static_cast<double>(line) / 400 - 17 * kPi / 180;
        const double sideways_um = eccentricity_um * std::sin(offset - from_high_spot);
        const double landed_um = radius_um * (std::asin((beam_um - sideways_um) / radius_um) - offset);
        most = std::max(most, std::abs(landed_um));
        ASSERT_NEAR(made.value().pulse_error(0, line, 20).across_um, -landed_um, worst * 1e-3) << line;
      }
      EXPECT_NEAR(most, worst, worst * 2e-2) << offset_deg << " " << eccentricity_um;
      EXPECT_GE(made.value().job_bound().bound.landing_um, most);
      EXPECT_LE(made.value().job_bound().bound.landing_um, worst * 1.05) << "lines lie a little to either side";
    }
  }
}

TEST(ErrorModel, AxisStartsWhereItsSpinUpHasLeftIt) {
  Job job = small_job(130);
  job.mode = Mode::helical;
  job.carriage = {ratio(333, 10), 3, ratio(2001, 100), 8, 20'000'000, {100, 5'000, 500'000}};
  job.rotary.limits = {360'000, 3'600'000, ratio(360'000'000, 7)};
  job.fpga.max_prescaler = 60'000;
  const Plan plan = plan_of(job, 200, 3);
  ASSERT_TRUE(plan.spin && plan.carriage->spin);
  const AbPlan& ab = plan.carriage->ab;
  const auto waited =
      static_cast<std::int64_t>(static_cast<std::uint64_t>(plan.carriage->spin->up.ticks) % ab.prescaler);
  ASSERT_GT(waited, 0) << "it waits at rest for the other axis";
  const SpinStart begun = spin_start(ab, plan.carriage->spin);
  const Integer edge = Integer(1) << static_cast<unsigned>(ab.counter_bits - 2);
  TwinSettings twin = no_terms();
  twin.ab_step = true;
  const ErrorModel model = model_of(plan, nullptr, twin);
  const double step_um = to_double(Rational(plan.carriage->feed_um / plan.carriage->edges_per_revolution));
  const Rational per_tick =
      (Rational(Integer(ab.increment)) + ratio(Integer(ab.fraction_num), Integer(ab.fraction_den))) /
      Rational(Integer(ab.prescaler)) / Rational(edge);
  for (std::int64_t pixel = 0; pixel < plan.line.pixels; ++pixel) {
    const std::int64_t tick = (plan.line.forward_first_slot + pixel) * plan.clock.ticks_per_slot;
    const SpinPhase now = phase_after(ab, ab.increment, tick + waited, {Integer(begun.counts), begun.accumulator});
    const Rational leads = Rational(Integer(now.counts / edge)) - per_tick * Rational(tick);
    ASSERT_NEAR(model.pulse_error(0, 0, pixel).along_um, -to_double(leads) * step_um, 1e-9) << pixel;
  }
}

TEST(ErrorModel, AnIncrementThatIsAllFractionMovesTheAxis) {
  Job job = small_job(13);
  job.fpga.counter_bits = 8;
  job.rotary.encoder_lines = 100;
  job.rotary.interpolation_bits = 0;
  const Plan plan = plan_of(job, 40, 2);
  ASSERT_EQ(plan.ab.increment, 0U);
  ASSERT_GT(plan.ab.fraction_num, 0U);
  TwinSettings twin = no_terms();
  twin.ab_step = true;
  const ErrorModel model = model_of(plan, nullptr, twin);
  const double step_um = to_double(Rational(plan.rotary.circumference_um / plan.rotary.edges_per_revolution));
  EXPECT_NEAR(model.job_bound().bound.landing_um, step_um, step_um * 2e-2) << "one edge";
}

TEST(ErrorModel, AHigherSurfaceIsMetEarlierUnderSlantingLight) {
  const Plan plan = plan_of(roller_job(), 3500, 2);
  const auto trajectory = trajectory_of(plan, roller_head(), {}, 20);
  TwinSettings twin = no_terms();
  twin.thermal = {true, 20, ratio(115, 10)};
  const ErrorModel model = model_of(plan, &trajectory, twin);
  const double growth_um = to_double(plan.rotary.circumference_um) / (2 * kPi) * 230e-6;
  // The light falls in from above, 20 degrees off the normal: on a higher surface it lands nearer to the top.
  EXPECT_NEAR(model.pulse_error(0, 0, 1750).across_um, growth_um * std::tan(kPi / 9), 0.01);
}

TEST(ErrorModel, TenMicrometresOfDiameterChangeThePitchAndLeaveTheSeamClosed) {
  const Plan plan = plan_of(roller_job(), 3500, 3);
  const auto trajectory = trajectory_of(plan, roller_head());
  TwinSettings twin = no_terms();
  twin.drift = twin.ab_step = true;
  const ErrorModel measured = model_of(plan, &trajectory, twin);
  twin.thermal = {true, 10, ratio(1000, 70)};  // 70 mm * 10 K * 14.29 um/(m K) = 10 um
  const ErrorModel grown = model_of(plan, &trajectory, twin);
  const double step_um = to_double(Rational(plan.rotary.circumference_um / plan.rotary.edges_per_revolution));
  EXPECT_NEAR(grown.pulse_error(0, 0, 0).defocus_um - measured.pulse_error(0, 0, 0).defocus_um, 5, 1e-7);
  for (const std::int64_t revolution : {0, 1, 2}) {  // angles stay: every line is where it was, round after round
    EXPECT_NEAR(grown.pulse_error(revolution, 0, 1750).across_um, measured.pulse_error(revolution, 0, 1750).across_um,
                1e-3);
    EXPECT_LT(std::abs(grown.pulse_error(revolution, 27'488, 1750).across_um), 1.1 * step_um);
  }
  // Along the axis columns grow apart from column 0.
  EXPECT_NEAR(grown.pulse_error(1, 5, 0).along_um, 0, 1e-9);
  EXPECT_NEAR(grown.pulse_error(1, 5, 3499).along_um, 3499 * 8 * 10.0 / 70'000, 1e-6);
}

TEST(ErrorModel, ThermalGrowthOfAPanelStartsAtItsFirstLineWhicheverWayItRuns) {
  Job job = small_job(50);
  job.mode = Mode::flat;
  job.stage = {50, 8, 20, 4, 2'000'000, {}};
  const Plan plan = plan_of(job, 40, 2);
  TwinSettings twin = no_terms();
  twin.thermal = {true, 100, 10};
  const ErrorModel model = model_of(plan, nullptr, twin);
  EXPECT_NEAR(model.pulse_error(0, 49, 0).across_um, 49 * 8 * 1e-3, 1e-9);
  EXPECT_NEAR(model.pulse_error(1, 0, 0).across_um, -49 * 8 * 1e-3, 1e-9) << "the second pass begins at the last line";
  EXPECT_NEAR(model.pulse_error(1, 49, 0).across_um, 0, 1e-9);
}

/// Where the stage of a panel is, in edges from where line 0 of the image begins: run by run from the places of rest,
/// by the signed edges of the board.
struct PanelStage {
  const Plan& plan;
  AxisCheck check = AxisCheck::make(plan).value();

  Rational edges_at(std::int64_t pass, std::int64_t tick) const {
    const std::int64_t lines = plan.rotary.lines_per_revolution;
    if (!plan.spin) {  // it is supposed to be in place when a pass begins
      const Rational begin = pass % 2 == 0 ? Rational(0) : plan.rotary.edges_per_revolution;
      return begin + Rational(check.edges_in_run(pass * lines, tick));
    }
    const Integer edge = Integer(1) << static_cast<unsigned>(plan.ab.counter_bits - 2);
    Integer rest = 0;
    for (std::int64_t before = 0; before < pass; ++before) {
      rest += *check.rest_counts(before * lines) / edge;
    }
    const Integer up = plan.spin->up.counts / edge;
    return Rational(Integer(rest + check.spun_up_counts(pass * lines) / edge - up)) +
           Rational(check.edges_in_run(pass * lines, tick));
  }
};

TEST(ErrorModel, PassesOfAPanelLandWhereTheSignedEdgesOfTheBoardPutThem) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 40; ++trial) {
    Job job = small_job(50);
    job.mode = Mode::flat;
    job.fpga.fractional = dice.coin();
    job.fpga.max_prescaler = static_cast<std::uint64_t>(dice.between(1, 9));
    job.stage = {
        dice.between(2, 60), ratio(dice.between(50, 90), 9), 20, static_cast<int>(dice.between(0, 8)), 20'000'000, {}};
    if (dice.coin()) {
      job.stage.limits = {2000, 200'000, 50'000'000};
    }
    job.limits.seam_um = 100;
    const Result<Plan> made = make_plan(job, 40, 3);
    ASSERT_TRUE(made) << made.error().message;
    const Plan& plan = made.value();
    TwinSettings twin = no_terms();
    twin.drift = twin.ab_step = true;
    const ErrorModel model = model_of(plan, nullptr, twin);
    const PanelStage stage{plan};
    const Rational per_edge_um = plan.rotary.circumference_um / plan.rotary.edges_per_revolution;
    const std::int64_t lines = plan.rotary.lines_per_revolution;
    for (int pulse = 0; pulse < 60; ++pulse) {
      const std::int64_t pass = dice.between(0, 2);
      const std::int64_t line = dice.between(0, lines - 1);
      const std::int64_t pixel = dice.between(0, plan.line.pixels - 1);
      const bool reverse = line_is_reverse(plan, pass, line);
      const std::int64_t slot =
          reverse ? plan.line.reverse_first_slot + plan.line.pixels - 1 - pixel : plan.line.forward_first_slot + pixel;
      const std::int64_t tick = (pass * lines + line) * plan.line.ticks + slot * plan.clock.ticks_per_slot +
                                (reverse ? plan.line.offset_remainder_ticks : 0);
      // On the panel the lines of a way back come from its end, each from its far side.
      const Rational along_pass = ratio(tick - pass * lines * plan.line.ticks, lines * plan.line.ticks);
      const bool back = pass % 2 != 0;
      const Rational target_um = (back ? Rational(1 - along_pass) : along_pass) * plan.rotary.circumference_um;
      const Rational landed_um = stage.edges_at(pass, tick) * per_edge_um;
      ASSERT_NEAR(model.pulse_error(pass, line, pixel).across_um,
                  to_double(Rational(target_um - landed_um)) * (back ? -1 : 1), 1e-6)
          << "pass " << pass << ", line " << line << (plan.spin ? ", spun up" : "");
    }
  }
}

TEST(ErrorModel, AServoLagsTheOtherWayOnTheWayBack) {
  Job job = small_job(50);
  job.mode = Mode::flat;
  job.stage = {50, 8, 20, 4, 2'000'000, {}};
  const Plan plan = plan_of(job, 40, 2);
  TwinSettings twin = no_terms();
  twin.servo = {true, 50, ratio(7, 10)};
  const ErrorModel model = model_of(plan, nullptr, twin);
  const double there = model.pulse_error(0, 20, 7).across_um;
  EXPECT_GT(there, 0) << "short of its target, which lies onwards";
  EXPECT_NEAR(model.pulse_error(1, 20, 7).across_um, there, 1e-9) << "the same the way the stage goes, so on the panel "
                                                                     "the two passes are apart by twice the lag";
}

}  // namespace
}  // namespace gravure::test
