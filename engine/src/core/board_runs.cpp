#include "gravure/core/board_runs.hpp"

namespace gravure {
namespace {

std::vector<ScheduleSegment> schedule_of(const std::vector<SpinSegment>& segments) {
  std::vector<ScheduleSegment> schedule;
  schedule.reserve(segments.size());
  for (const SpinSegment& segment : segments) {
    schedule.push_back({segment.increment, static_cast<std::uint64_t>(segment.seeds)});
  }
  return schedule;
}

/// Of every run of a plan.
std::int64_t revolutions_per_run(const Plan& plan) {
  return plan.mode == Mode::flat ? 1 : revolutions_per_band(plan);
}

CarriageSetup carriage_setup(const CarriagePlan& carriage) {
  CarriageSetup setup;
  setup.prescaler = carriage.ab.prescaler;
  setup.increment = carriage.ab.increment;
  setup.fraction_num = carriage.ab.fraction_num;
  setup.fraction_den = carriage.ab.fraction_den;
  if (carriage.spin) {
    setup.spin_up = schedule_of(carriage.spin->up.segments);
    setup.spin_down = schedule_of(carriage.spin->down.segments);
  }
  return setup;
}

}  // namespace

BoardRun run_with(const Plan& plan, std::int64_t revolution) {
  BoardRun run;
  run.revolutions = revolutions_per_run(plan);
  run.first_revolution = revolution - revolution % run.revolutions;
  run.backward = plan.mode == Mode::flat && (revolution & 1) != 0;
  run.band = plan.bands ? revolution / plan.bands->revolutions_per_band : 0;
  run.axial_mm = plan.bands ? Rational(plan.bands->step_mm * run.band) : Rational(0);
  run.first_tick = run.first_revolution * plan.rotary.ticks_per_revolution;
  run.ticks = run.revolutions * plan.rotary.ticks_per_revolution;
  return run;
}

std::vector<BoardRun> runs_of(const Plan& plan) {
  std::vector<BoardRun> runs;
  const std::int64_t revolutions = revolutions_per_run(plan);
  runs.reserve(static_cast<std::size_t>(plan.job.revolutions / revolutions));
  for (std::int64_t revolution = 0; revolution < plan.job.revolutions; revolution += revolutions) {
    runs.push_back(run_with(plan, revolution));
  }
  return runs;
}

DeviceSetup device_setup(const Plan& plan, std::int64_t revolution, std::int64_t line) {
  const BoardRun run = run_with(plan, revolution);
  DeviceSetup setup;
  setup.counter_bits = plan.ab.counter_bits;
  setup.prescaler = plan.ab.prescaler;
  setup.increment = plan.ab.increment;
  setup.fraction_num = plan.ab.fraction_num;
  setup.fraction_den = plan.ab.fraction_den;
  setup.backward = run.backward;
  if (plan.carriage) {
    setup.carriage = carriage_setup(*plan.carriage);
  }
  if (plan.spin) {
    setup.spin_up = schedule_of(plan.spin->up.segments);
    setup.spin_down = schedule_of(plan.spin->down.segments);
  }
  setup.clock_multiplier = plan.clock.ticks_per_slot / plan.clock.pulse_divider;
  setup.ticks_per_slot = plan.clock.ticks_per_slot;
  setup.slots_per_line = plan.line.slots;
  setup.window_slots = plan.line.pixels;
  setup.lines_per_revolution = plan.rotary.lines_per_revolution;
  setup.begin_revolution = run.first_revolution;
  setup.end_revolution = run.end_revolution();
  setup.first_revolution = revolution;
  setup.first_line = line;
  return setup;
}

}  // namespace gravure
