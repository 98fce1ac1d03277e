#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <vector>

#include "gravure/motion/monotone_spline.hpp"
#include "gravure/motion/plan_profile.hpp"
#include "gravure/motion/search.hpp"

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

std::vector<Mode> table_modes() {
  const FrequencyAndDamping modes[] = {{36.206, 0.2249}, {86.748, 0.0331}};
  return chain_modes(modes).value();
}

const SFactorRequest kIndexing{{20, 375, 14000, 13500, 0, 0}, 82.5, 250};

/// Residual acceleration when the move ends, by its jumps.
double closed_form(const std::vector<Mode>& modes, const std::vector<InputJump>& input) {
  return residual_of(modes, input, BandOf::acceleration).at(0);
}

/// The same by Runge-Kutta of fourth order in modal coordinates, steps ending on the segment borders.
double runge_kutta(const std::vector<Mode>& modes, const Profile& profile, double step_s) {
  double acceleration = 0;
  for (const Mode& mode : modes) {
    const double w = 6.283185307179586 * mode.f_hz;
    const double c = 2 * mode.zeta * w;
    double z = 0;
    double r = 0;
    for (std::size_t k = 0; k < 7; ++k) {
      const double length = profile.durations_s[k];
      const double steps = std::ceil(length / step_s);
      const double h = steps > 0 ? length / steps : 0;
      for (double i = 0; i < steps; ++i) {
        const double a0 = profile.acceleration_mm_s2[k] + profile.jerk_mm_s3[k] * i * h;
        const double am = a0 + profile.jerk_mm_s3[k] * h / 2;
        const double a1 = a0 + profile.jerk_mm_s3[k] * h;
        const auto slope = [&](double zz, double rr, double a) { return -a - c * rr - w * w * zz; };
        const double r1 = slope(z, r, a0);
        const double r2 = slope(z + h / 2 * r, r + h / 2 * r1, am);
        const double r3 = slope(z + h / 2 * (r + h / 2 * r1), r + h / 2 * r2, am);
        const double r4 = slope(z + h * (r + h / 2 * r2), r + h * r3, a1);
        const double z_next = z + h * r + h * h / 6 * (r1 + r2 + r3);
        r += h / 6 * (r1 + 2 * r2 + 2 * r3 + r4);
        z = z_next;
      }
    }
    acceleration += mode.participation * (-c * r - w * w * z);
  }
  return acceleration;
}

void respond_closed_form(benchmark::State& state) {
  const auto modes = table_modes();
  const auto input = input_of(plan_profile(kIndexing).value());
  for (auto _ : state) {
    benchmark::DoNotOptimize(closed_form(modes, input));
  }
}

/// CPU seconds of one call, over many.
template <class Call>
double seconds_of(const Call& call, int times) {
  const std::clock_t start = std::clock();
  for (int i = 0; i < times; ++i) {
    benchmark::DoNotOptimize(call());
  }
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / times;
}

/// `error` says how far it is off, relative to the closed form, which is itself exact to about 1e-12; `times_closed`
/// how many times longer it takes, both measured here in turn.
void respond_runge_kutta(benchmark::State& state) {
  const auto modes = table_modes();
  const Profile profile = plan_profile(kIndexing).value();
  const auto input = input_of(profile);
  const double step_s = static_cast<double>(state.range(0)) * 1e-7;
  double result = 0;
  for (auto _ : state) {
    result = runge_kutta(modes, profile, step_s);
    benchmark::DoNotOptimize(result);
  }
  const double closed_s = seconds_of([&] { return closed_form(modes, input); }, 200'000);
  state.counters["times_closed"] = seconds_of([&] { return runge_kutta(modes, profile, step_s); }, 3) / closed_s;
  state.counters["error"] = std::abs(result / closed_form(modes, input) - 1);
}

void settle_one(benchmark::State& state) {
  const auto modes = table_modes();
  const auto input = input_of(plan_profile(kIndexing).value());
  for (auto _ : state) {
    benchmark::DoNotOptimize(settle(modes, input, {BandOf::acceleration, 840}));
  }
}

SearchProblem table_problem() {
  return {20, 500, 30000, 30000, 1e21, 250, table_modes(), {BandOf::acceleration, 840}, 5};
}

void search_grid_points(benchmark::State& state, bool asymmetric) {
  const SearchProblem problem = table_problem();
  std::uint64_t points = 0;
  for (auto _ : state) {
    points += search_grid(problem, {}, asymmetric).value().evaluated;
  }
  state.counters["s_per_profile"] =
      benchmark::Counter(static_cast<double>(points), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void search_global(benchmark::State& state, bool robust) {
  const SearchProblem problem = table_problem();
  SearchOptions options;
  options.robust = robust;
  std::uint64_t evaluated = 0;
  for (auto _ : state) {
    evaluated += search(problem, options).value().evaluated;
  }
  state.counters["s_per_profile"] =
      benchmark::Counter(static_cast<double>(evaluated), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// 100,000 samples x 2,000 control points, with reverse stretches (`constrained`) or the plain fit.
void fit_spline(benchmark::State& state, int direction) {
  std::vector<double> parameter;
  std::vector<double> value;
  for (int k = 0; k < 100'000; ++k) {
    const double s = k * 1e-5;
    parameter.push_back(s);
    value.push_back(3 * s + 0.004 * std::sin(1e5 * s * s) + 0.03 * std::sin(40 * 6.283185307179586 * s));
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(fit_monotone({parameter, value, 2000, direction}));
  }
}

BENCHMARK_CAPTURE(fit_spline, plain, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit_spline, monotone, 1)->Unit(benchmark::kMillisecond);
BENCHMARK(respond_closed_form);
BENCHMARK(respond_runge_kutta)->Arg(1000)->Arg(100)->Arg(10)->Arg(1);
BENCHMARK(settle_one);
BENCHMARK_CAPTURE(search_grid_points, symmetric, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(search_grid_points, asymmetric, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(search_global, exact, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(search_global, with_robust, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan_jerk_limited, rest_to_rest, 0.0);
BENCHMARK_CAPTURE(plan_jerk_limited, moving_start, 0.3);
BENCHMARK(plan_s_factor);

}  // namespace
}  // namespace gravure::motion
