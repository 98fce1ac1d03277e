#include "gravure/registration/refine_contours.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "registration_test_support.hpp"

namespace gravure::registration {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

/// Round the blade at heights 10, 25, ... on the suction side.
std::vector<Contour> rings() {
  std::vector<Contour> all;
  for (int k = 0; k < 10; ++k) {
    Contour ring;
    ring.id = k;
    for (int i = 0; i <= 40; ++i) {
      ring.points_mm.push_back(BladeSurface::on_blade(0.4 + 2.3 * i / 40, 10 + 14.0 * k).point);
    }
    ring.direction = BladeSurface::on_blade(1.57, 10 + 14.0 * k).normal;
    all.push_back(ring);
  }
  return all;
}

/// Bent out of the surface: by up to a millimetre, more towards the tip.
Point3 bent_point(Point3 point) {
  point[1] += 1.0 * std::pow(std::max(0.0, point[2]) / BladeSurface::kSpanMm, 2);
  return point;
}

struct Errors {
  double normal_mm = 0;  ///< rms out of the surface, against where the bent part has the contours
  double most_direction = 0;
};

Errors errors_of(const std::vector<PlacedContour>& placed, const std::vector<Contour>& contours,
                 const Similarity& truth) {
  Errors errors;
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < placed.size(); ++k) {
    for (std::size_t i = 0; i < contours[k].points_mm.size(); ++i) {
      const Point3 normal =
          BladeSurface::on_blade(0.4 + 2.3 * static_cast<double>(i) / 40, 10 + 14.0 * static_cast<double>(k)).normal;
      const Eigen::Vector3d off =
          vec(placed[k].contour.points_mm[i]) - vec(truth.point(bent_point(contours[k].points_mm[i])));
      squares += std::pow(vec(truth.direction(normal)).dot(off), 2);
      ++count;
    }
    errors.most_direction = std::max(
        errors.most_direction, (vec(placed[k].contour.direction) - vec(truth.direction(contours[k].direction))).norm());
    EXPECT_NEAR(vec(placed[k].contour.direction).norm(), 1, 1e-12);
  }
  errors.normal_mm = std::sqrt(squares / static_cast<double>(count));
  return errors;
}

TEST(RefineContours, FollowABentPartBetterThanTheWholePose) {
  GRAVURE_TRACE_DICE();
  Dice dice;
  const PointSet cad = BladeSurface::points(60'000, dice);
  PointSet scan = without_normals(BladeSurface::points(60'000, dice));
  std::transform(scan.points_mm.begin(), scan.points_mm.end(), scan.points_mm.begin(), bent_point);
  const Similarity truth = pose(0.2, {1, 2, 3}, {5, -3, 2}, 1.01);
  scan = moved(scan, truth, 0.01, dice);
  RegistrationOptions options;
  options.with_scale = true;
  const Registration whole = register_scan({cad, {}}, scan, options).value();
  const std::vector<Contour> contours = rings();
  std::vector<PlacedContour> as_whole;
  for (const Contour& contour : contours) {
    PlacedContour one{contour};
    for (Point3& point : one.contour.points_mm) {
      point = whole.cad_to_scan.point(point);
    }
    one.contour.direction = whole.cad_to_scan.direction(contour.direction);
    as_whole.push_back(one);
  }
  const double before = errors_of(as_whole, contours, truth).normal_mm;
  const auto refined = refine_contours({cad, {}}, scan, whole, contours, {}).value();
  const Errors after = errors_of(refined, contours, truth);
  ContourOptions bend;
  bend.bend = true;
  const Errors bent_after = errors_of(refine_contours({cad, {}}, scan, whole, contours, bend).value(), contours, truth);
  EXPECT_LT(after.normal_mm, 0.35 * before);
  EXPECT_LT(bent_after.normal_mm, 0.01);
  EXPECT_LT(after.most_direction, 0.02);
  EXPECT_GE(std::count_if(refined.begin(), refined.end(), [](const PlacedContour& one) { return one.refined; }), 9);
  for (const PlacedContour& one : refined) {
    EXPECT_GT(one.scan_points, 500);
    EXPECT_LT(one.rms_mm, 0.03);
  }
}

TEST(RefineContours, LeavesAContourWithoutScanWhereTheWholePoseHasIt) {
  GRAVURE_TRACE_DICE();
  Dice dice(1);
  const PointSet cad = BladeSurface::points(30'000, dice);
  PointSet scan;
  for (const Point3& point : BladeSurface::points(20'000, dice).points_mm) {
    if (point[2] < 60) {
      scan.points_mm.push_back(point);
    }
  }
  const Registration whole = register_scan({cad, {}}, scan, {}).value();
  const std::vector<Contour> contours = rings();
  const auto placed = refine_contours({cad, {}}, scan, whole, contours, {}).value();
  EXPECT_TRUE(placed.front().refined);
  EXPECT_FALSE(placed.back().refined);
  EXPECT_LT(placed.back().moved_mm, 1e-3);
  EXPECT_TRUE(refine_contours({cad, {}}, scan, whole, {}, {}).value().empty());
  ContourOptions wrong;
  wrong.crop_mm = 1e308;
  EXPECT_EQ(refine_contours({cad, {}}, scan, whole, contours, wrong).error().message,
            "crop_mm = 1e+308: must be 0.01 to 10000");
  wrong = {};
  wrong.bend_mm = 0;
  EXPECT_EQ(refine_contours({cad, {}}, scan, whole, contours, wrong).error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace gravure::registration
