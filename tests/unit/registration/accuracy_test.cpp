#include <gtest/gtest.h>

#include <algorithm>

#include "registration_test_support.hpp"

namespace gravure::registration {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kNoiseMm = 0.01;
const Eigen::Vector3d kAxis(1, 2, -1.5);

struct Blades {
  PointSet cad;
  PointSet samples;  ///< of the same surface, other places: what the scan sees, before it is moved
};

Blades blades(std::size_t cad, std::size_t scan, Dice& dice) {
  Blades made{BladeSurface::points(cad, dice), BladeSurface::points(scan, dice)};
  return made;
}

Registration registered(const PointSet& cad, const PointSet& scan, const RegistrationOptions& options) {
  auto result = register_scan({cad, {}}, scan, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? std::move(result).value() : Registration{};
}

TEST(RegisterScan, FindsThePoseToTwoMicrometresAtTenOfNoise) {
  GRAVURE_TRACE_DICE();
  Dice dice;
  const Blades made = blades(100'000, 50'000, dice);
  const Similarity truth = pose(0.6 * kDegree, kAxis, {0.3, -0.35, 0.2});
  const Registration found = registered(made.cad, without_normals(moved(made.samples, truth, kNoiseMm, dice)), {});
  EXPECT_TRUE(found.converged);
  EXPECT_FALSE(found.degenerate);
  EXPECT_FALSE(found.ambiguous);
  EXPECT_LT(rms_between(found.cad_to_scan, truth, made.cad.points_mm), 0.002);
  EXPECT_NEAR(found.rms_mm, kNoiseMm, 0.001);
  EXPECT_GT(static_cast<double>(found.inliers), 0.99 * 50'000);
  EXPECT_EQ(found.eigenvalues.size(), 6U);
}

struct ScaleCase {
  const char* name;
  std::size_t cad_points;
  std::size_t scan_points;
  std::uint32_t dice;
  double scale_error;
  double rms_mm;
};

class RegisterScanScaled : public testing::TestWithParam<ScaleCase> {};

TEST_P(RegisterScanScaled, FindsPoseAndScale) {
  GRAVURE_TRACE_DICE();
  Dice dice(GetParam().dice);
  const Blades made = blades(GetParam().cad_points, GetParam().scan_points, dice);
  const Similarity truth = pose(0.6 * kDegree, kAxis, {0.3, -0.35, 0.2}, 1.01);
  RegistrationOptions options;
  options.with_scale = true;
  const Registration found = registered(made.cad, without_normals(moved(made.samples, truth, kNoiseMm, dice)), options);
  EXPECT_TRUE(found.converged);
  EXPECT_FALSE(found.scale_refused);
  EXPECT_NEAR(found.cad_to_scan.scale, 1.01, GetParam().scale_error);
  EXPECT_LT(rms_between(found.cad_to_scan, truth, made.cad.points_mm), GetParam().rms_mm);
  EXPECT_EQ(found.eigenvalues.size(), 7U);
}

INSTANTIATE_TEST_SUITE_P(Points, RegisterScanScaled,
                         testing::Values(ScaleCase{"FiftyThousand", 100'000, 50'000, 1, 2e-4, 0.002},
                                         ScaleCase{"TwoHundredThousand", 200'000, 200'000, 5, 1e-4, 0.001}),
                         [](const auto& tested) { return tested.param.name; });

/// The tip is not in the scan, a fifth of the points.
TEST(RegisterScan, FindsThePoseWhereFourFifthsOverlap) {
  GRAVURE_TRACE_DICE();
  Dice dice(6);
  const Blades made = blades(100'000, 62'500, dice);
  std::vector<double> heights;
  for (const Point3& point : made.samples.points_mm) {
    heights.push_back(point[2]);
  }
  std::nth_element(heights.begin(), heights.begin() + 50'000, heights.end());
  PointSet seen;
  for (const Point3& point : made.samples.points_mm) {
    if (point[2] < heights[50'000]) {
      seen.points_mm.push_back(point);
    }
  }
  ASSERT_EQ(seen.points_mm.size(), 50'000U);
  const Similarity truth = pose(0.6 * kDegree, kAxis, {0.3, -0.35, 0.2}, 1.01);
  RegistrationOptions options;
  options.with_scale = true;
  const Registration found = registered(made.cad, moved(seen, truth, kNoiseMm, dice), options);
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.cad_to_scan.scale, 1.01, 2e-4);
  EXPECT_LT(rms_between(found.cad_to_scan, truth, made.cad.points_mm), 0.002);
  EXPECT_GT(static_cast<double>(found.inliers), 0.99 * 50'000);
}

/// Bent by `most_mm` at the tip, along y.
PointSet bent(PointSet set, double most_mm) {
  for (Point3& point : set.points_mm) {
    point[1] += most_mm * std::pow(std::max(0.0, point[2]) / BladeSurface::kSpanMm, 2);
  }
  return set;
}

double rms_of_pairs(const Similarity& pose, const std::vector<Point3>& from, const std::vector<Point3>& to) {
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    sum += (vec(pose.point(from[i])) - vec(to[i])).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(from.size()));
}

TEST(RegisterScan, ComesNearTheBestSimilarityOfABentBlade) {
  GRAVURE_TRACE_DICE();
  Dice dice(2);
  const Blades made = blades(100'000, 50'000, dice);
  const Similarity truth = pose(0.6 * kDegree, kAxis, {0.3, -0.35, 0.2}, 1.01);
  const PointSet scan = without_normals(moved(bent(made.samples, 0.1), truth, kNoiseMm, dice));
  RegistrationOptions options;
  options.with_scale = true;
  const Registration found = registered(made.cad, scan, options);
  const Similarity best = similarity_of_pairs(made.samples.points_mm, scan.points_mm, true).value();
  EXPECT_LT(rms_of_pairs(found.cad_to_scan, made.samples.points_mm, scan.points_mm), 0.04);  // 0.0206 at best
  // In what is made least, distances from the surface, nothing is left to win.
  double squares = 0;
  for (std::size_t i = 0; i < scan.points_mm.size(); ++i) {
    const Eigen::Vector3d back = vec(best.inverse().point(scan.points_mm[i]));
    squares += std::pow(vec(made.samples.normals[i]).dot(back - vec(made.samples.points_mm[i])), 2);
  }
  EXPECT_LT(found.rms_mm, std::sqrt(squares / static_cast<double>(scan.points_mm.size())));
}

/// Foot of the blade and platform on one side: a fifth of all.
bool on_part(const Point3& point) {
  return point[2] < 40 && point[0] > 0;
}

TEST(RegisterScan, HoldsWhenOnlyAFifthOfTheScanIsOnTheCad) {
  GRAVURE_TRACE_DICE();
  Dice dice(3);
  const Blades made = blades(300'000, 50'000, dice);
  PointSet cad;
  for (std::size_t i = 0; i < made.cad.points_mm.size(); ++i) {
    if (on_part(made.cad.points_mm[i])) {
      cad.points_mm.push_back(made.cad.points_mm[i]);
      cad.normals.push_back(made.cad.normals[i]);
    }
  }
  const Similarity truth = pose(0.6 * kDegree, kAxis, {0.3, -0.35, 0.2}, 1.01);
  const PointSet scan = without_normals(moved(bent(made.samples, 0.1), truth, kNoiseMm, dice));
  RegistrationOptions options;
  options.with_scale = true;
  const Registration found = registered(cad, scan, options);
  std::vector<Point3> from;
  std::vector<Point3> to;
  for (std::size_t i = 0; i < scan.points_mm.size(); ++i) {
    if (on_part(made.samples.points_mm[i])) {
      from.push_back(made.samples.points_mm[i]);
      to.push_back(scan.points_mm[i]);
    }
  }
  EXPECT_NEAR(static_cast<double>(from.size()), 10'000, 1500);
  EXPECT_LT(rms_of_pairs(found.cad_to_scan, from, to), 0.06);
}

TEST(RegisterScan, ComesBackFromAnyStart) {
  GRAVURE_TRACE_DICE();
  Dice dice(4);
  const Blades made = blades(40'000, 20'000, dice);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::Vector3d axis(BladeSurface::normal(dice), BladeSurface::normal(dice), BladeSurface::normal(dice));
    const double angle = trial < 4 ? 0.3 * trial : 3.14 * BladeSurface::unit(dice);
    const Similarity truth = pose(angle, axis, 5 * axis.normalized());
    PointSet scan = without_normals(moved(made.samples, truth, kNoiseMm, dice));
    if (trial % 2 == 1) {  // a fifth is missing, and one point in fifty is anywhere
      std::vector<Point3> kept;
      for (const Point3& point : scan.points_mm) {
        if (truth.inverse().point(point)[2] < 115) {
          kept.push_back(point);
        }
        if (dice.between(0, 49) == 0) {
          kept.push_back(
              {point[0] + 20 * BladeSurface::normal(dice), point[1] + 20 * BladeSurface::normal(dice), point[2]});
        }
      }
      scan.points_mm = kept;
    }
    const Registration found = registered(made.cad, scan, {});
    const double off = rms_between(found.cad_to_scan, truth, made.cad.points_mm);
    EXPECT_LT(off, 0.005) << "trial " << trial;
  }
}

}  // namespace
}  // namespace gravure::registration
