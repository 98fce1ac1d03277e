#include <benchmark/benchmark.h>

#include <cstddef>
#include <vector>

#include "gravure/motion/plan_profile.hpp"

namespace gravure::motion {
namespace {

std::vector<JerkRequest> requests(double end_velocity_fraction) {
  std::vector<JerkRequest> list;
  double x = 0.5;
  const auto draw = [&x](double low, double high) {
    x = 3.99 * x * (1 - x);  // any spread of strokes and limits over all branches
    return low + (high - low) * x;
  };
  for (int i = 0; i < 4096; ++i) {
    JerkRequest r{
        {draw(0.001, 200), draw(10, 500), draw(1e3, 3e4), draw(1e3, 3e4), 0, 0}, draw(1e5, 1e7), draw(1e5, 1e7)};
    r.move.start_velocity_mm_s = end_velocity_fraction * r.move.v_max_mm_s;
    list.push_back(r);
  }
  return list;
}

void plan_jerk_limited(benchmark::State& state, double end_velocity_fraction) {
  const auto list = requests(end_velocity_fraction);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(plan_profile(list[i++ % list.size()]));
  }
}

void plan_s_factor(benchmark::State& state) {
  const auto list = requests(0);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(plan_profile(SFactorRequest{list[i++ % list.size()].move, 40, 250}));
  }
}

BENCHMARK_CAPTURE(plan_jerk_limited, rest_to_rest, 0.0);
BENCHMARK_CAPTURE(plan_jerk_limited, moving_start, 0.3);
BENCHMARK(plan_s_factor);

}  // namespace
}  // namespace gravure::motion
