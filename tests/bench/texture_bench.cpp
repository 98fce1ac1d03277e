// What freeform textures cost: the published case of 65,536 points ([A]) from the search for sigma to the proof, and a
// picture of 4 megapixels. Comparisons run in the same process: the filter by FFT beside the sum it stands for.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "gravure/kinematics/machines.hpp"
#include "gravure/texture/best_sigma.hpp"
#include "gravure/texture/decomposition.hpp"
#include "gravure/texture/following_error.hpp"
#include "gravure/texture/picture_path.hpp"
#include "gravure/texture/planar_path.hpp"

namespace gravure::texture {
namespace {

template <class T>
T must(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().message.c_str());
    std::exit(1);
  }
  return std::move(result).value();
}

/// The surface and the curve of docs/texture.md.
struct Published {
  std::unique_ptr<Surface> surface = must(expression_surface("2.6*(cos(2*pi*x/39+0.3)+cos(2*pi*y/39+1.1))"));
  std::unique_ptr<Splitter> splitter = make_splitter(SplitMethod::gaussian, {.cut = 4});
  TexturePath path{must(hilbert_curve(8, 40)), 40.0 / 255};
  PathMachine machine{kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, Vector3::Zero(), {}),
                      published_limits(), Stops::points, 50e-6};
};

Published& published() {
  static Published one;
  return one;
}

TimedSplit split_at(Published& p, double sigma_mm) {
  return must(time_split(must(split_path(*p.splitter, *p.surface, p.path, {}, sigma_mm, {})), p.path, p.machine, {}));
}

void per_point(benchmark::State& state, std::size_t points) {
  state.counters["us_per_point"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(points) / 1e6,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// 2,048 x 2,048 pixels of 10 um on a saddle; points 100 um apart, as the verbs put them.
TexturePath picture() {
  return must(picture_path(
      {.columns = 2048, .rows = 2048, .pixel_mm = 0.01, .line_mm = 0.01, .run_out_mm = 0.5, .step_mm = 0.1},
      10'000'000));
}

void sigma_search(benchmark::State& state) {
  Published& p = published();
  for (auto _ : state) {
    benchmark::DoNotOptimize(must(split_by_published_rule(*p.splitter, *p.surface, p.path, {}, {})).sigma_mm);
  }
}
BENCHMARK(sigma_search)->Unit(benchmark::kMillisecond);

void split_for_time(benchmark::State& state) {
  Published& p = published();
  for (auto _ : state) {
    benchmark::DoNotOptimize(must(split_by_time(*p.splitter, *p.surface, p.path, {}, p.machine, 0.005, {})).tries);
  }
}
BENCHMARK(split_for_time)->Unit(benchmark::kMillisecond);

void closed_form_axes(benchmark::State& state) {
  Published& p = published();
  const Split split = must(split_path(*p.splitter, *p.surface, p.path, {}, 3.5, {}));
  for (auto _ : state) {
    benchmark::DoNotOptimize(must(seven_axes(p.machine.machine, split.targets, split.stages)).size());
  }
  per_point(state, split.targets.size());
}
BENCHMARK(closed_form_axes)->Unit(benchmark::kMillisecond);

/// Times without the proof.
void plan_curve(benchmark::State& state) {
  Published& p = published();
  const TimedSplit timed = split_at(p, 3.5);
  const PathTimingRequest request = timed.request(p.machine, p.path);
  for (auto _ : state) {
    benchmark::DoNotOptimize(must(time_seven_axes(request, {})).time_s);
  }
  per_point(state, timed.axes.size());
}
BENCHMARK(plan_curve)->Unit(benchmark::kMillisecond);

/// Every limit over all 21 million periods.
void prove_curve(benchmark::State& state) {
  Published& p = published();
  const TimedSplit timed = split_at(p, 3.5);
  for (auto _ : state) {
    benchmark::DoNotOptimize(must(prove_limits(*timed.timed.motion, p.machine.limits, p.machine.servo_s, {})).size());
  }
  state.counters["ns_per_period"] =
      benchmark::Counter(static_cast<double>(state.iterations() * timed.timed.motion->instants()) / 1e9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(prove_curve)->Unit(benchmark::kMillisecond);

void predict_curve(benchmark::State& state) {
  Published& p = published();
  const TimedSplit timed = split_at(p, 3.5);
  const RotaryTable table = must(rotary_table(p.machine.machine));
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        must(predict_following(*timed.timed.motion, assumed_servos(), table, p.machine.servo_s, {})).spot_mm.max);
  }
}
BENCHMARK(predict_curve)->Unit(benchmark::kMillisecond);

/// From the split to motion with every limit proved.
void plan_picture(benchmark::State& state) {
  Published& p = published();
  const TexturePath path = picture();
  const auto saddle = must(expression_surface("0.004*x*y"));
  PathMachine machine = p.machine;
  machine.stops = Stops::corners;
  for (auto _ : state) {
    const Split split = must(split_path(*p.splitter, *saddle, path, {}, 3, {}));
    const auto axes = must(seven_axes(machine.machine, split.targets, split.stages));
    const std::vector<double> pulse_mm = pulse_lengths_mm(path, split.targets);
    const PathTimingRequest request{.targets = split.targets,
                                    .axes = axes,
                                    .pulse_mm = pulse_mm,
                                    .table = must(rotary_table(machine.machine)),
                                    .limits = machine.limits,
                                    .stops = machine.stops,
                                    .servo_s = machine.servo_s,
                                    .sigma_points = split.sigma_mm / path.step_mm};
    const ProvenPath proven = must(prove_seven_axes(request, {}));
    state.counters["machine_s"] = proven.path.time_s;
    state.counters["proofs"] = proven.proofs;
    state.counters["broken"] = static_cast<double>(broken(proven.uses).size());
  }
  per_point(state, path.points_mm.size());
}
BENCHMARK(plan_picture)->Unit(benchmark::kMillisecond)->Iterations(1);

/// A million points: by FFT, whatever sigma is (100 and 1,000 points).
void filter_by_fft(benchmark::State& state) {
  const std::vector<Vector2> path = must(hilbert_curve(10, 40));
  const double step_mm = 40.0 / 1023;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        must(slow_part(path, step_mm, {.sigma_mm = step_mm * static_cast<double>(state.range(0)), .cut = 4})).data());
  }
}
BENCHMARK(filter_by_fft)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

/// The same by the sum itself, the ends left out.
void filter_by_sum(benchmark::State& state) {
  const std::vector<Vector2> path = must(hilbert_curve(10, 40));
  const auto sigma = static_cast<double>(state.range(0));
  const auto radius = static_cast<Eigen::Index>(4 * sigma + 0.5);
  Eigen::VectorXd weights(2 * radius + 1);
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    const double at = static_cast<double>(k - radius) / sigma;
    weights[k] = std::exp(-at * at / 2);
  }
  weights /= weights.sum();
  const auto points =
      Eigen::Map<const Eigen::Matrix2Xd>(path.data()->data(), 2, static_cast<Eigen::Index>(path.size()));
  const Eigen::VectorXd x = points.row(0);
  const Eigen::VectorXd y = points.row(1);
  for (auto _ : state) {
    double sum = 0;
    for (Eigen::Index i = 0; i + weights.size() <= x.size(); ++i) {
      sum += weights.dot(x.segment(i, weights.size())) + weights.dot(y.segment(i, weights.size()));
    }
    benchmark::DoNotOptimize(sum);
  }
}
BENCHMARK(filter_by_sum)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gravure::texture
