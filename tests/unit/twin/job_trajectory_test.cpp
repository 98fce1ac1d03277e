#include "gravure/scan/job_trajectory.hpp"

#include <cmath>

#include "budget_support.hpp"
#include "dice.hpp"
#include "gravure/scan/plan_trajectory.hpp"

/// The terms of the scanner against the whole chain, pulse by pulse: set-points of that very line, mirrors, kinematics.
namespace gravure::test {
namespace {

Job scanner_job(Dice& dice, Mode mode) {
  Job job = small_job(dice.between(60, 200));
  job.mode = mode;
  job.scanner.field_mm = 12;
  job.scanner.resolution_bits = static_cast<int>(dice.between(14, 18));
  job.scanner.slots_per_microvector = dice.between(1, 9);
  job.scanner.lag_us = ratio(dice.between(0, 60), 10);
  job.scanner.compensate_lag = dice.coin();
  job.scanner.cross_scan_correction = dice.coin();
  job.scanner.offset_deg = mode == Mode::flat ? 0 : dice.between(-30, 30);
  job.scanner.bidirectional_offset_ticks = dice.between(-2, 2) * 50;
  job.scanner.turn_slots = 120;
  job.carriage = {ratio(dice.between(20, 200), 7), 2, 20, 6, 41'000'000, {}};
  job.stage = {job.rotary.lines_per_revolution.value(), 8, 20, 6, 2'000'000, {}};
  job.rotary.encoder_lines = 100;
  return job;
}

void expect_landings(const Plan& plan, Dice& dice) {
  const auto job = scan::JobTrajectory::make(plan);
  ASSERT_TRUE(job) << job.error().message;
  const auto trajectory = scan::plan_trajectory(plan);
  ASSERT_TRUE(trajectory) << trajectory.error().message;
  const Result<ErrorModel> made =
      ErrorModel::make(plan, &trajectory.value(), scanner_terms(), &job.value().of_revolution(1));
  ASSERT_TRUE(made) << made.error().message;
  const ErrorModel& model = made.value();
  const scan::LandingModel real = scan::landing_model(trajectory.value());
  const double count_um = trajectory.value().resolution_mm * 1000;
  for (int pulse = 0; pulse < 30; ++pulse) {
    const std::int64_t revolution = dice.between(0, plan.job.revolutions - 1);
    const std::int64_t line = dice.between(0, plan.rotary.lines_per_revolution - 1);
    const std::int64_t pixel = dice.between(0, plan.line.pixels - 1);
    const scan::LineNumber number{revolution, line};
    const auto direction = job.value().direction_of(number);
    const std::int64_t slot = trajectory.value().path.timing().slot_of_pixel(direction, pixel);
    const auto state = job.value().at(number, slot, real);
    ASSERT_TRUE(state) << state.error().message;
    const kinematics::Vector3 target = job.value().target_of(number, pixel);
    const kinematics::Vector3 missed = (target - state.value().spot_mm) * 1000;
    const PulseError error = model.pulse_error(revolution, line, pixel);
    const double radius = std::hypot(target.y(), target.z());
    const double across = plan.mode == Mode::flat
                              ? missed.y() * (revolution % 2 == 0 ? 1 : -1)  // the way the lines follow each other
                              : radius * 1000 *
                                    std::remainder(std::atan2(target.y(), target.z()) -
                                                       std::atan2(state.value().spot_mm.y(), state.value().spot_mm.z()),
                                                   2 * kPi);
    // The tangent plane instead of the surface: a distance of d um moves by d^2 / radius.
    const double bent = plan.mode == Mode::flat ? 0 : 2 * across * across / (radius * 1000);
    // The first pulses of a helical line may come while U still goes from one fraction of a column to the next.
    const double late = plan.carriage && !plan.scanner->compensate_lag ? model.late_shift_um() + count_um : 0;
    ASSERT_NEAR(error.along_um, missed.x(), 1e-3 + count_um * 1e-3 + late) << mode_name(plan.mode) << " line " << line;
    ASSERT_LE(std::hypot(missed.x(), across), model.line_bound(revolution, line).landing_um + 2e-3 + bent);
    ASSERT_NEAR(error.across_um, across, 1e-3 + bent) << mode_name(plan.mode) << " line " << line;
  }
}

TEST(ErrorModel, ScannerTermsAreThoseOfTheWholeChainInEveryMode) {
  SCOPED_TRACE(Dice::note());
  Dice dice(5);
  int plans = 0;
  for (int trial = 0; trial < 200 && plans < 45; ++trial) {
    const Mode mode = static_cast<Mode>(trial % 3);
    const Job job = scanner_job(dice, mode);
    const Result<Plan> plan = make_plan(job, dice.between(20, 60), 2);
    if (!plan || !scan::plan_trajectory(plan.value())) {
      continue;
    }
    ++plans;
    expect_landings(plan.value(), dice);
    if (HasFatalFailure()) {
      return;
    }
  }
  EXPECT_GE(plans, 45);
}

}  // namespace
}  // namespace gravure::test
