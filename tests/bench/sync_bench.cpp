#include <benchmark/benchmark.h>

#include <cstdint>
#include <limits>
#include <random>
#include <utility>

#include "gravure/formats/plan_json.hpp"
#include "gravure/sync/ab_ratio.hpp"
#include "gravure/sync/make_plan.hpp"
#include "gravure/sync/suggest.hpp"

namespace {

using namespace gravure;

constexpr std::uint64_t kMost64 = std::numeric_limits<std::uint64_t>::max();

/// Roller of 70 mm: 82 MHz seed, every 41st pulse, 27,489 lines of 3909 slots.
Job roller_job() {
  Job job;
  job.laser = {.seed_hz = 82'000'000, .pulse_divider = 41, .max_pulse_on_demand_hz = 16'400'000};
  job.fpga = {.clock_multiplier = 2, .counter_bits = 32, .fractional = false, .max_prescaler = 4'294'967'295U};
  job.scanner.pixel_pitch_um = 8;
  job.scanner.turn_slots = 409;
  job.rotary.diameter_mm = Rational(70);
  job.rotary.line_pitch_um = Rational(8);
  job.rotary.encoder_lines = 11'840;
  job.rotary.interpolation_bits = 13;
  job.rotary.max_ab_hz = 2'000'000;
  job.limits.seam_um = Rational(1, 2);
  return job;
}

constexpr std::int64_t kPixels = 3500;
constexpr std::int64_t kRevolutions = 100;

/// A ratio of consecutive Fibonacci numbers of some bits: every partial quotient is 1, the most steps there can be.
Rational golden_ratio(unsigned bits) {
  Integer small = 1;
  Integer large = 2;
  while (msb(large) < bits) {
    small += large;
    std::swap(small, large);
  }
  return ratio(large, small);
}

/// The argument is how many bits the wanted ratio has; a job's stay below 130.
void best_pair_golden(benchmark::State& state) {
  const Rational wanted = golden_ratio(static_cast<unsigned>(state.range(0)));
  const Rational most(largest_increment(64));
  for (auto _ : state) {
    benchmark::DoNotOptimize(best_ab_pair(wanted, 64, kMost64, most));
  }
}
BENCHMARK(best_pair_golden)->Arg(60)->Arg(130)->Arg(400);

/// Random ratios of 64-bit numbers.
void best_pair_random(benchmark::State& state) {
  std::mt19937_64 random(1);
  const Rational most(largest_increment(64));
  for (auto _ : state) {
    state.PauseTiming();
    const Rational wanted = ratio(Integer(random() | 1U) * (random() >> 40U), Integer(random() | 1U));
    state.ResumeTiming();
    benchmark::DoNotOptimize(best_ab_pair(wanted, 64, kMost64, most));
  }
}
BENCHMARK(best_pair_random);

void plan_roller(benchmark::State& state) {
  const Job job = roller_job();
  for (auto _ : state) {
    benchmark::DoNotOptimize(make_plan(job, kPixels, kRevolutions));
  }
}
BENCHMARK(plan_roller);

/// The best of as many line lengths as the argument says.
void plan_extra_slots(benchmark::State& state) {
  Job job = roller_job();
  job.scanner.max_extra_slots = state.range(0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(make_plan(job, kPixels, kRevolutions));
  }
}
BENCHMARK(plan_extra_slots)->Arg(300)->Arg(10'000)->Unit(benchmark::kMillisecond);

/// q as the argument says, 401 line lengths, nL +- 1000: about 800,000 candidates.
void suggest_roller(benchmark::State& state) {
  Job job = roller_job();
  job.rotary.interpolation_bits = static_cast<int>(state.range(0));
  const SuggestTolerances tolerances{.lines_per_revolution = 1000,
                                     .extra_slots = 400,
                                     .pitch_percent = Rational(100),
                                     .diameter_um = Rational(1'000'000),
                                     .most_suggestions = 20};
  for (auto _ : state) {
    benchmark::DoNotOptimize(suggest(job, kPixels, kRevolutions, tolerances));
  }
  state.counters["candidates/s"] = benchmark::Counter(401.0 * 2001.0, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(suggest_roller)->Arg(0)->Arg(13)->Unit(benchmark::kMillisecond);

void json_round_trip(benchmark::State& state) {
  const Plan plan = make_plan(roller_job(), kPixels, kRevolutions).value();
  for (auto _ : state) {
    benchmark::DoNotOptimize(plan_from_json(plan_to_json(plan)));
  }
}
BENCHMARK(json_round_trip);

}  // namespace
