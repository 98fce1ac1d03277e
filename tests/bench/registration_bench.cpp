// Registration of a scan of the closed-form blade, on one thread, trees and Morton order included.

#include <benchmark/benchmark.h>

#include <flann/flann.hpp>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "registration_case.hpp"

namespace {

using gravure::PointSet;
using namespace gravure::bench;  // NOLINT(google-build-using-namespace)

void register_blade(benchmark::State& state) {
  Dice dice;
  gravure::registration::CadModel cad;
  cad.samples = BladeSurface::points(static_cast<std::size_t>(state.range(1)), dice);
  gravure::registration::RegistrationOptions options;
  options.with_scale = state.range(2) != 0;
  const double scale = options.with_scale ? 1.01 : 1;
  const PointSet scan = scan_of(static_cast<std::size_t>(state.range(0)), scale, dice);
  for (auto _ : state) {
    const auto result = gravure::registration::register_scan(cad, scan, options);
    if (!result || !result.value().converged) {
      std::abort();
    }
    state.counters["pose_error_um"] = pose_error_um(cad.samples, result.value().cad_to_scan, true_pose(scale));
    state.counters["iterations"] = result.value().iterations;
  }
}
BENCHMARK(register_blade)
    ->ArgNames({"scan", "cad", "scale"})
    ->Args({50'000, 100'000, 0})
    ->Args({50'000, 100'000, 1})
    ->Args({200'000, 200'000, 1})
    ->Unit(benchmark::kMillisecond);

/// The textbook's ICP on the same points and the same tree: nearest points within 2 mm, Umeyama's rigid motion, until a
/// step moves less than 0.1 um or 100 steps are done.
void plain_icp(benchmark::State& state) {
  Dice dice;
  const PointSet cad = BladeSurface::points(static_cast<std::size_t>(state.range(1)), dice);
  const PointSet scan = scan_of(static_cast<std::size_t>(state.range(0)), 1, dice);
  for (auto _ : state) {
    std::vector<gravure::Point3> samples = cad.points_mm;
    flann::KDTreeSingleIndex<flann::L2_3D<double>> tree(
        flann::Matrix<double>(samples.front().data(), samples.size(), 3), flann::KDTreeSingleIndexParams(16, true));
    tree.buildIndex();
    std::vector<gravure::Point3> there = scan.points_mm;
    Similarity to_cad;
    int steps = 0;
    for (double moved = 1; moved > 1e-4 && steps < 100; ++steps) {
      flann::Matrix<double> places(there.front().data(), there.size(), 3);
      std::vector<std::size_t> nearest(there.size());
      std::vector<double> squared(there.size());
      flann::Matrix<std::size_t> found(nearest.data(), there.size(), 1);
      flann::Matrix<double> distances(squared.data(), there.size(), 1);
      tree.knnSearch(places, found, distances, 1, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
      std::vector<gravure::Point3> from;
      std::vector<gravure::Point3> to;
      for (std::size_t i = 0; i < there.size(); ++i) {
        if (squared[i] < 4) {
          from.push_back(there[i]);
          to.push_back(cad.points_mm[nearest[i]]);
        }
      }
      const auto step = gravure::registration::similarity_of_pairs(from, to, false);
      if (!step) {
        std::abort();
      }
      moved = 0;
      for (gravure::Point3& point : there) {
        const gravure::Point3 next = step.value().point(point);
        moved =
            std::max(moved, std::abs(next[0] - point[0]) + std::abs(next[1] - point[1]) + std::abs(next[2] - point[2]));
        point = next;
      }
      to_cad = composed(step.value(), to_cad);
    }
    state.counters["pose_error_um"] = pose_error_um(cad, to_cad.inverse(), true_pose(1));
    state.counters["iterations"] = steps;
  }
}
BENCHMARK(plain_icp)->ArgNames({"scan", "cad"})->Args({50'000, 100'000})->Unit(benchmark::kMillisecond);

}  // namespace
