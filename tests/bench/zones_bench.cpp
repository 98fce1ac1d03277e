// Zones of a part like that of [D], and the clustering beside FLANN's, on one thread.

#include <benchmark/benchmark.h>
#include <flann/flann.hpp>

#include <cstdlib>
#include <numbers>
#include <vector>

#include "ceramic_core.hpp"
#include "gravure/zones/counter_random.hpp"
#include "gravure/zones/k_means.hpp"
#include "gravure/zones/plan_zones.hpp"

namespace {

constexpr std::size_t kDimensions = 6;

std::vector<double> scattered(std::size_t count) {
  std::vector<double> points(count * kDimensions);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = gravure::zones::random_fraction(11, 0, i);
  }
  return points;
}

void k_means(benchmark::State& state) {
  const std::vector<double> points = scattered(static_cast<std::size_t>(state.range(0)));
  const auto clusters = static_cast<std::size_t>(state.range(1));
  for (auto _ : state) {
    const auto found = gravure::zones::k_means(points, {clusters, kDimensions, 1, 1});
    if (!found) {
      std::abort();
    }
    state.counters["inertia"] = found.value().inertia;
    state.counters["rounds"] = found.value().rounds;
  }
}

/// Also one start of k-means++, until nothing changes.
void flann_k_means(benchmark::State& state) {
  std::vector<double> points = scattered(static_cast<std::size_t>(state.range(0)));
  const auto clusters = static_cast<std::size_t>(state.range(1));
  for (auto _ : state) {
    std::vector<double> stored(clusters * kDimensions);
    flann::Matrix<double> centres(stored.data(), clusters, kDimensions);
    const int made = flann::hierarchicalClustering<flann::L2<double>>(
        flann::Matrix<double>(points.data(), points.size() / kDimensions, kDimensions), centres,
        flann::KMeansIndexParams(static_cast<int>(clusters), -1, flann::FLANN_CENTERS_KMEANSPP));
    double inertia = 0;
    for (std::size_t i = 0; i < points.size(); i += kDimensions) {
      double least = 1e300;
      for (std::size_t c = 0; c < static_cast<std::size_t>(made); ++c) {
        least = std::min(least, flann::L2<double>()(points.data() + i, centres[c], kDimensions));
      }
      inertia += least;
    }
    state.counters["inertia"] = inertia;
  }
}
BENCHMARK(k_means)->Args({10'000, 10})->Args({100'000, 50})->Unit(benchmark::kMillisecond);
BENCHMARK(flann_k_means)->Args({10'000, 10})->Args({100'000, 50})->Unit(benchmark::kMillisecond);

void plan_core(benchmark::State& state) {
  gravure::zones::ZonePlanRequest request;
  request.contours = gravure::test::CeramicCore::contours();
  request.max_incidence_rad = 5 * std::numbers::pi / 180;
  request.max_layer_mm = 0.15;
  request.machine = gravure::zones::example_machine();
  for (auto _ : state) {
    const auto plan = gravure::zones::plan_zones(request);
    if (!plan) {
      std::abort();
    }
    state.counters["zones"] = static_cast<double>(plan.value().zones.size());
  }
}
BENCHMARK(plan_core)->Unit(benchmark::kMillisecond);

}  // namespace
