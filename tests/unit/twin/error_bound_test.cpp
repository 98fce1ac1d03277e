#include <algorithm>
#include <cmath>
#include <map>

#include "budget_support.hpp"
#include "dice.hpp"
#include "gravure/core/exposure_map.hpp"

/// Bounds in closed form against the simulation of every pulse, on random jobs of all modes.
namespace gravure::test {
namespace {

/// No bound is more than so many times what the worst pulse of a job does (docs/error_budget.md).
constexpr double kBoundFactor = 2;

Job random_small_job(Dice& dice) {
  const std::int64_t lines = dice.between(4, 90);
  Job job = small_job(lines);
  job.mode = static_cast<Mode>(dice.between(0, 2));
  job.fpga.fractional = dice.coin();
  job.fpga.counter_bits = static_cast<int>(dice.between(18, 64));
  job.fpga.max_prescaler = static_cast<std::uint64_t>(dice.between(1, 100));
  job.scanner.bidirectional = dice.between(0, 3) > 0;
  job.scanner.bidirectional_offset_ticks = dice.between(0, 2) * 82;
  job.scanner.slots_per_microvector = dice.between(1, 8);
  job.scanner.turn_slots = dice.between(30, 60);
  job.rotary.encoder_lines = dice.between(50, 5000);
  job.carriage = {ratio(dice.between(20, 200), 10),     dice.between(1, 3), ratio(dice.between(50, 400), 10),
                  static_cast<int>(dice.between(3, 8)), 41'000'000,         {}};
  job.stage = {lines, 8, ratio(dice.between(50, 400), 10), static_cast<int>(dice.between(3, 8)), 2'000'000, {}};
  if (dice.coin()) {  // from rest, the axes together
    job.rotary.limits = {3'600'000, 36'000'000, 360'000'000};
    job.carriage.limits = {10'000, 1'000'000, 100'000'000};
    job.stage.limits = job.carriage.limits;
  }
  if (job.mode != Mode::helical && dice.coin()) {
    job.scanner.field_mm = ratio(8 * dice.between(12, 30) + 7, 1000);
  }
  return job;
}

/// The largest error of all pulses that expose something.
PulseSums simulated(const Plan& plan, const ErrorModel& model) {
  const ExposureMap map(plan);
  std::vector<std::byte> fired(static_cast<std::size_t>((plan.line.pixels + 7) / 8));
  PulseSums sums;
  for (std::int64_t revolution = 0; revolution < plan.job.revolutions; ++revolution) {
    for (std::int64_t line = 0; line < plan.rotary.lines_per_revolution; ++line) {
      std::fill(fired.begin(), fired.end(), std::byte{0});
      for (std::int64_t index = 0; index < map.stretches(); ++index) {
        const Stretch stretch = map.stretch(revolution, line, index);
        for (std::int64_t i = 0; i < stretch.columns; ++i) {
          const std::int64_t pixel = stretch.first_pixel + i;
          const std::int64_t at = line_is_reverse(plan, revolution, line) ? plan.line.pixels - 1 - pixel : pixel;
          fired[static_cast<std::size_t>(at / 8)] |= std::byte{0x80} >> (at % 8);
        }
      }
      const PulseSums before = sums;
      sums.worst_um2 = -1;
      model.simulate(revolution, line, fired, sums);
      const double most = model.line_bound(revolution, line).landing_um;
      EXPECT_LE(std::sqrt(std::max(0.0, sums.worst_um2)), most * (1 + 1e-9) + 1e-9) << revolution << " " << line;
      if (sums.worst_um2 < before.worst_um2) {
        sums.worst_um2 = before.worst_um2;
        sums.worst = before.worst;
      }
    }
  }
  return sums;
}

/// Do the pulses see the A-B signal at many different times between two edges? Where they come in step with it the
/// bound, which does not know how long the job is, cannot be near.
bool samples_edges(const Plan& plan, const AbPlan& ab) {
  const double edges_per_slot = to_double(Rational(
      (Rational(ab.increment) + ratio(Integer(ab.fraction_num), Integer(ab.fraction_den))) * plan.clock.ticks_per_slot /
      (Rational(Integer(Integer(1) << static_cast<unsigned>(ab.counter_bits - 2))) * Rational(Integer(ab.prescaler)))));
  for (int beat = 1; beat <= 8; ++beat) {
    const double off = edges_per_slot * beat - std::round(edges_per_slot * beat);
    if (std::abs(off) * static_cast<double>(plan.line.pixels * plan.rotary.lines_per_revolution) < 4 * beat) {
      return false;
    }
  }
  return true;
}

TwinSettings with_term(Dice& dice, std::size_t term, const Plan& plan) {
  TwinSettings twin = no_terms();
  const bool all = term == kErrorTerms;
  const auto on = [all, term](ErrorTerm which) { return all || term == static_cast<std::size_t>(which); };
  twin.drift = on(ErrorTerm::drift);
  twin.ab_step = on(ErrorTerm::ab_step);
  twin.galvo_resolution = on(ErrorTerm::galvo_resolution);
  twin.microvectors = on(ErrorTerm::microvectors);
  twin.cross_scan = on(ErrorTerm::cross_scan);
  twin.lag = on(ErrorTerm::lag);
  twin.defocus = on(ErrorTerm::defocus);
  twin.servo = {on(ErrorTerm::servo), dice.between(5, 50'000), ratio(dice.between(5, 200), 100)};
  const Rational radius_um = plan.rotary.circumference_um / (2 * pi());
  twin.run_out = {on(ErrorTerm::run_out), radius_um * ratio(dice.between(1, 30), 100), dice.between(-360, 360)};
  twin.thermal = {on(ErrorTerm::thermal), dice.between(-50, 50), dice.between(5, 20)};
  return twin;
}

TEST(ErrorBound, HoldsEveryPulseAndIsWithinItsFactorForEachTermAndForAll) {
  SCOPED_TRACE(Dice::note());
  Dice dice(77);
  std::map<Mode, int> plans;
  std::map<std::size_t, double> widest;
  for (int trial = 0; trial < 400 && (plans[Mode::rotary] < 12 || plans[Mode::helical] < 12 || plans[Mode::flat] < 12);
       ++trial) {
    const Job job = random_small_job(dice);
    const std::int64_t exposures = job.mode == Mode::helical ? job.carriage.layers : dice.between(1, 5);
    const Result<Plan> made = make_plan(job, dice.between(20, 80), exposures);
    if (!made || plans[job.mode] >= 12) {
      continue;
    }
    const Plan& plan = made.value();
    if (!samples_edges(plan, plan.ab) || (plan.carriage && !samples_edges(plan, plan.carriage->ab))) {
      continue;
    }
    ++plans[job.mode];
    kinematics::ScanHead head;
    head.field_mm = 12;
    head.resolution_bits = static_cast<int>(dice.between(14, 20));
    head.lag_us = ratio(dice.between(0, 50), 10);
    if (dice.coin()) {
      head.lens = kinematics::Lens::f_theta;
      head.tilt_rad_per_mm = 0.01;
    }
    const double offset_deg = dice.coin() ? 0 : static_cast<double>(dice.between(-30, 30));
    const auto trajectory = trajectory_of(plan, head, {dice.coin(), dice.coin(), {}}, offset_deg);
    for (std::size_t term = 0; term <= kErrorTerms; ++term) {
      const TwinSettings twin = with_term(dice, term, plan);
      const ErrorModel model = model_of(plan, &trajectory, twin);
      const PulseSums sums = simulated(plan, model);
      const double most = std::sqrt(std::max(0.0, sums.worst_um2));
      const double bound = model.job_bound().bound.landing_um;
      ASSERT_GT(sums.pulses, 0);
      ASSERT_LE(most, bound * (1 + 1e-9) + 1e-9) << "term " << term << ", " << mode_name(job.mode);
      // What the first pulses of helical lines may be off by is in the bound alone.
      ASSERT_LE(bound - model.late_shift_um(), most * kBoundFactor + 1e-6)
          << "term " << term << ", " << mode_name(job.mode);
      if (most > 1e-6) {
        widest[term] = std::max(widest[term], bound / most);
      }
    }
  }
  EXPECT_GE(plans[Mode::rotary], 12);
  EXPECT_GE(plans[Mode::helical], 12);
  EXPECT_GE(plans[Mode::flat], 12);
  for (const auto& [term, factor] : widest) {
    RecordProperty("widest_factor_of_term_" + std::to_string(term), std::to_string(factor));
  }
}

}  // namespace
}  // namespace gravure::test
