// The blade of registration_bench by the ICP of PCL, on one thread, its tree included. CAD and scan are the same; PCL
// has single precision points, and takes the normals of the CAD as they are.

#include <benchmark/benchmark.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>

#include <cstdlib>

#include "registration_case.hpp"

namespace {

using gravure::PointSet;
using namespace gravure::bench;  // NOLINT(google-build-using-namespace)
using Cloud = pcl::PointCloud<pcl::PointNormal>;

Cloud::Ptr cloud_of(const PointSet& set) {
  auto cloud = std::make_shared<Cloud>();
  for (std::size_t i = 0; i < set.points_mm.size(); ++i) {
    pcl::PointNormal point;
    for (int k = 0; k < 3; ++k) {
      point.data[k] = static_cast<float>(set.points_mm[i][static_cast<std::size_t>(k)]);
      point.normal[k] = set.normals.empty() ? 0 : static_cast<float>(set.normals[i][static_cast<std::size_t>(k)]);
    }
    cloud->push_back(point);
  }
  return cloud;
}

/// Nearest points within 2 mm until a step is nothing or 100 are done, as plain_icp of registration_bench.
template <class Icp>
void register_by(benchmark::State& state) {
  Dice dice;
  const PointSet cad = BladeSurface::points(static_cast<std::size_t>(state.range(1)), dice);
  const PointSet scan = scan_of(static_cast<std::size_t>(state.range(0)), 1, dice);
  const Cloud::Ptr target = cloud_of(cad);
  const Cloud::Ptr source = cloud_of(scan);
  for (auto _ : state) {
    Icp icp;
    icp.setInputSource(source);
    icp.setInputTarget(target);
    icp.setMaxCorrespondenceDistance(2);
    icp.setMaximumIterations(100);
    icp.setTransformationEpsilon(1e-12);
    Cloud moved;
    icp.align(moved);
    if (!icp.hasConverged()) {
      std::abort();
    }
    const Eigen::Matrix4d matrix = icp.getFinalTransformation().template cast<double>();
    Similarity to_cad;
    to_cad.rotation = matrix.topLeftCorner<3, 3>();
    to_cad.translation_mm = matrix.topRightCorner<3, 1>();
    state.counters["pose_error_um"] = pose_error_um(cad, to_cad.inverse(), true_pose(1));
  }
}

using PointIcp = pcl::IterativeClosestPoint<pcl::PointNormal, pcl::PointNormal, double>;
using PlaneIcp = pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal, double>;
BENCHMARK(register_by<PointIcp>)->ArgNames({"scan", "cad"})->Args({50'000, 100'000})->Unit(benchmark::kMillisecond);
BENCHMARK(register_by<PlaneIcp>)->ArgNames({"scan", "cad"})->Args({50'000, 100'000})->Unit(benchmark::kMillisecond);

}  // namespace
