// Registration of a scan of the closed-form blade, on one thread, trees and Morton order included.

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <cstdlib>

#include "blade_surface.hpp"
#include "gravure/registration/register_scan.hpp"

namespace {

using gravure::PointSet;
using gravure::registration::Similarity;
using gravure::test::BladeSurface;
using gravure::test::Dice;

/// 10 um of noise; half a millimetre and 0.6 degrees away.
PointSet scan_of(std::size_t count, double scale, Dice& dice) {
  Similarity pose;
  pose.rotation = Eigen::AngleAxisd(0.0105, Eigen::Vector3d(1, 2, -1.5).normalized()).toRotationMatrix();
  pose.translation_mm = {0.3, -0.35, 0.2};
  pose.scale = scale;
  PointSet scan;
  for (const gravure::Point3& point : BladeSurface::points(count, dice).points_mm) {
    gravure::Point3 there = pose.point(point);
    for (double& value : there) {
      value += 0.01 * BladeSurface::normal(dice);
    }
    scan.points_mm.push_back(there);
  }
  return scan;
}

void register_blade(benchmark::State& state) {
  Dice dice;
  gravure::registration::CadModel cad;
  cad.samples = BladeSurface::points(static_cast<std::size_t>(state.range(1)), dice);
  gravure::registration::RegistrationOptions options;
  options.with_scale = state.range(2) != 0;
  const PointSet scan = scan_of(static_cast<std::size_t>(state.range(0)), options.with_scale ? 1.01 : 1, dice);
  for (auto _ : state) {
    const auto result = gravure::registration::register_scan(cad, scan, options);
    if (!result || !result.value().converged) {
      std::abort();
    }
    state.counters["rms_um"] = 1e3 * result.value().rms_mm;
    state.counters["iterations"] = result.value().iterations;
  }
}
BENCHMARK(register_blade)
    ->ArgNames({"scan", "cad", "scale"})
    ->Args({50'000, 100'000, 0})
    ->Args({50'000, 100'000, 1})
    ->Args({200'000, 200'000, 1})
    ->Unit(benchmark::kMillisecond);

}  // namespace
