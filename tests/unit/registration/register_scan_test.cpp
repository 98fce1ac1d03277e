#include <gtest/gtest.h>

#include <limits>

#include "registration_test_support.hpp"

namespace gravure::registration {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

TEST(SimilarityOfPairs, GivesBackWhatMovedThePoints) {
  GRAVURE_TRACE_DICE();
  Dice dice;
  const PointSet set = BladeSurface::points(500, dice);
  const Similarity truth = pose(0.05, {1, -2, 3}, {10, 20, -30}, 1.013);
  const PointSet there = moved(set, truth, 0, dice);
  const Similarity found = similarity_of_pairs(set.points_mm, there.points_mm, true).value();
  EXPECT_NEAR(found.scale, 1.013, 1e-14);
  EXPECT_TRUE(found.rotation.isApprox(truth.rotation, 1e-14));
  EXPECT_LT(rms_between(found, truth, set.points_mm), 1e-12);
  EXPECT_EQ(similarity_of_pairs(set.points_mm, there.points_mm, false).value().scale, 1);
  EXPECT_LT(rms_between(composed(found.inverse(), found), Similarity{}, set.points_mm), 1e-12);
  EXPECT_TRUE((found.matrix() * found.inverse().matrix()).isIdentity(1e-12));
}

TEST(SimilarityOfPairs, NeverReflects) {
  const std::vector<Point3> from{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  const std::vector<Point3> mirrored{{0, 0, 0}, {-1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  EXPECT_NEAR(similarity_of_pairs(from, mirrored, true).value().rotation.determinant(), 1, 1e-14);
}

TEST(SimilarityOfPairs, RefusesWhatHoldsNoPose) {
  const std::vector<Point3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_FALSE(similarity_of_pairs(line, line, false));
  EXPECT_FALSE(similarity_of_pairs(std::span(line).first(2), std::span(line).first(2), false));
  EXPECT_FALSE(similarity_of_pairs(line, std::span(line).first(2), false));
}

TEST(RegisterScan, IsTheSameEveryTimeAndToEveryOrderOfTheScan) {
  GRAVURE_TRACE_DICE();
  Dice dice(1);
  const PointSet cad = BladeSurface::points(20'000, dice);
  PointSet scan = moved(BladeSurface::points(8000, dice), pose(0.1, {1, 0, 1}, {1, 2, 3}), 0.01, dice);
  const Registration once = register_scan({cad, {}}, scan, {}).value();
  const Registration twice = register_scan({cad, {}}, scan, {}).value();
  EXPECT_EQ(once.cad_to_scan.matrix(), twice.cad_to_scan.matrix());
  std::reverse(scan.points_mm.begin(), scan.points_mm.end());
  std::reverse(scan.normals.begin(), scan.normals.end());
  const Registration reversed = register_scan({cad, {}}, scan, {}).value();
  EXPECT_LT(rms_between(once.cad_to_scan, reversed.cad_to_scan, cad.points_mm), 1e-6);
  EXPECT_EQ(once.residuals_mm.front(), once.residuals_mm.front());
  EXPECT_NEAR(once.residuals_mm.front(), reversed.residuals_mm.back(), 1e-6);
}

TEST(RegisterScan, EstimatesNormalsThatAreMissing) {
  GRAVURE_TRACE_DICE();
  Dice dice(2);
  const PointSet cad = BladeSurface::points(60'000, dice);
  const Similarity truth = pose(0.2, {1, 0, 1}, {1, 2, 3});
  const PointSet scan = moved(BladeSurface::points(10'000, dice), truth, 0.005, dice);
  const Registration found = register_scan({without_normals(cad), {}}, without_normals(scan), {}).value();
  EXPECT_TRUE(found.converged);
  EXPECT_LT(rms_between(found.cad_to_scan, truth, cad.points_mm), 0.01);
}

TEST(RegisterScan, LaysAScanOfOneSideOnThatSide) {
  GRAVURE_TRACE_DICE();
  Dice dice(3);
  const PointSet cad = BladeSurface::points(40'000, dice);
  PointSet side;  // the suction side and the platform
  for (int i = 0; i < 10'000; ++i) {
    auto sample = BladeSurface::anywhere(dice);
    if (sample.point[2] > 0) {
      sample = BladeSurface::on_blade(0.1 + 2.9 * BladeSurface::unit(dice), 150 * BladeSurface::unit(dice));
    }
    side.points_mm.push_back(sample.point);
    side.normals.push_back(sample.normal);
  }
  for (const double angle : {0.02, 2.0}) {
    const Similarity truth = pose(angle, {1, 0.2, 0.1}, {2, 1, 1});
    const Registration found = register_scan({cad, {}}, moved(side, truth, 0.005, dice), {}).value();
    EXPECT_LT(rms_between(found.cad_to_scan, truth, cad.points_mm), 0.02) << angle;
  }
}

TEST(RegisterScan, TakesTrianglesAsPlanes) {
  GRAVURE_TRACE_DICE();
  Dice dice(4);
  // The blade as triangles, 300 round and 150 up, and a floor.
  TriangleMesh mesh;
  constexpr std::uint32_t kRound = 300;
  constexpr std::uint32_t kUp = 150;
  for (std::uint32_t row = 0; row <= kUp; ++row) {
    for (std::uint32_t i = 0; i < kRound; ++i) {
      mesh.vertices_mm.push_back(BladeSurface::on_blade(2 * 3.14159265358979 * i / kRound, 150.0 * row / kUp).point);
    }
  }
  for (std::uint32_t row = 0; row < kUp; ++row) {
    for (std::uint32_t i = 0; i < kRound; ++i) {
      const std::uint32_t a = row * kRound + i;
      const std::uint32_t b = row * kRound + (i + 1) % kRound;
      mesh.triangles.push_back({a, b, a + kRound});
      mesh.triangles.push_back({b, b + kRound, a + kRound});
    }
  }
  mesh.vertices_mm.insert(mesh.vertices_mm.end(), {{-40, -25, 0}, {40, -25, 0}, {40, 27, 0}});
  const auto last = static_cast<std::uint32_t>(mesh.vertices_mm.size());
  mesh.triangles.push_back({last - 3, last - 2, last - 1});
  const PointSet there = sample_mesh(mesh, 20'000);
  EXPECT_NEAR(static_cast<double>(there.points_mm.size()), 20'000, 2);
  const Similarity truth = pose(0.3, {1, 0, 1}, {1, 2, 3}, 1.02);
  RegistrationOptions options;
  options.with_scale = true;
  const Registration found = register_scan({{}, mesh}, moved(there, truth, 0, dice), options).value();
  EXPECT_LT(rms_between(found.cad_to_scan, truth, mesh.vertices_mm), 5e-4);
  EXPECT_LT(found.rms_mm, 5e-4);
}

TEST(RegisterScan, RefusesWhatItCannotWorkWith) {
  Dice dice;
  const PointSet cad = BladeSurface::points(1000, dice);
  PointSet few;
  few.points_mm.assign(29, {1, 2, 3});
  const auto code = [](const auto& result) {
    return result ? std::string("none") : std::string(error_code_name(result.error().code));
  };
  EXPECT_EQ(code(register_scan({cad, {}}, few, {})), "bad_argument");
  EXPECT_EQ(code(register_scan({few, {}}, cad, {})), "bad_argument");
  few.points_mm.assign(100, {1, 2, 3});
  EXPECT_EQ(code(register_scan({few, {}}, cad, {})), "bad_argument");
  PointSet wrong = cad;
  wrong.normals.pop_back();
  EXPECT_EQ(code(register_scan({wrong, {}}, cad, {})), "bad_argument");
  EXPECT_EQ(code(register_scan({cad, {}}, wrong, {})), "bad_argument");
  wrong = cad;
  wrong.points_mm[7][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(register_scan({cad, {}}, wrong, {})), "bad_argument");
  EXPECT_EQ(code(register_scan({wrong, {}}, cad, {})), "bad_argument");
  RegistrationOptions options;
  options.most_scale = 1;
  EXPECT_EQ(code(register_scan({cad, {}}, cad, options)), "bad_argument");
  options = {};
  options.start.rotation *= 2;
  EXPECT_EQ(code(register_scan({cad, {}}, cad, options)), "bad_argument");
  options = {};
  options.weak_share = 0;
  EXPECT_EQ(code(register_scan({cad, {}}, cad, options)), "bad_argument");
  options = {};
  options.most_iterations = 0;
  EXPECT_EQ(code(register_scan({cad, {}}, cad, options)), "bad_argument");
}

TEST(RegisterScan, IsNeverSilentlyWrongWhereNothingFits) {
  GRAVURE_TRACE_DICE();
  Dice dice(5);
  const PointSet cad = BladeSurface::points(5000, dice);
  PointSet other;  // points of a ball, and all at one place
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d place =
        20 * Eigen::Vector3d(BladeSurface::normal(dice), BladeSurface::normal(dice), BladeSurface::normal(dice));
    other.points_mm.push_back({place[0], place[1], place[2]});
  }
  const auto ball = register_scan({cad, {}}, other, {});
  EXPECT_TRUE(!ball || !ball.value().converged);
  other.points_mm.assign(100, {1e6, 0, 0});
  const auto one_place = register_scan({cad, {}}, other, {});
  EXPECT_TRUE(!one_place || one_place.value().degenerate || !one_place.value().converged);
}

}  // namespace
}  // namespace gravure::registration
