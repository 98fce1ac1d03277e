#include "gravure/texture/planar_path.hpp"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace gravure::texture {
namespace {

TEST(HilbertCurve, VisitsEveryCellOnceInStepsOfThePitch) {
  for (int order = 1; order <= 7; ++order) {
    const auto curve = hilbert_curve(order, 40);
    ASSERT_TRUE(curve);
    const std::vector<Vector2>& points = curve.value();
    const int side = 1 << order;
    const double pitch_mm = 40.0 / (side - 1);
    std::set<std::pair<long, long>> cells;
    for (std::size_t i = 0; i < points.size(); ++i) {
      cells.emplace(std::lround((points[i].x() + 20) / pitch_mm), std::lround((points[i].y() + 20) / pitch_mm));
      if (i > 0) {
        ASSERT_NEAR((points[i] - points[i - 1]).norm(), pitch_mm, 1e-12) << "order " << order << ", point " << i;
      }
    }
    EXPECT_EQ(cells.size(), points.size());
    EXPECT_EQ(points.front(), Vector2(-20, -20));
    EXPECT_EQ(points.back(), Vector2(20, -20));
  }
}

/// [A]: 65,536 points, 156.8627 um apart, 10.280 m; straight runs of one, two and three segments.
TEST(HilbertCurve, OfOrderEightIsThePublishedOne) {
  const std::vector<Vector2> points = hilbert_curve(8, 40).value();
  ASSERT_EQ(points.size(), 65'536U);
  EXPECT_NEAR(arc_lengths_mm(points).back(), 10'280, 0.5);
  int runs[4] = {};
  int run = 1;
  for (std::size_t i = 2; i <= points.size(); ++i) {
    const bool straight = i < points.size() && (points[i] - 2 * points[i - 1] + points[i - 2]).norm() < 1e-9;
    if (straight) {
      ++run;
      continue;
    }
    ASSERT_LE(run, 3);
    ++runs[run];
    run = 1;
  }
  EXPECT_EQ(runs[1], 40'415);
  EXPECT_EQ(runs[2], 10'922);
  EXPECT_EQ(runs[3], 1'092);
}

TEST(HilbertCurve, RefusesOrdersAndSizesThatMakeNone) {
  EXPECT_EQ(hilbert_curve(0, 40).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(hilbert_curve(13, 40).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(hilbert_curve(3, 0).error().code, ErrorCode::out_of_range);
}

TEST(Resample, KeepsToThePathAndItsEnds) {
  const std::vector<Vector2> path = {{0, 0}, {3, 0}, {3, 0}, {3, 4}};
  const std::vector<Vector2> points = resample(path, 0.4, 100).value();
  ASSERT_EQ(points.size(), 19U);
  EXPECT_LT((points[5] - Vector2(2, 0)).norm(), 1e-12);
  EXPECT_LT((points[10] - Vector2(3, 1)).norm(), 1e-12);
  EXPECT_EQ(points.back(), Vector2(3, 4));
}

TEST(Resample, RefusesStepsThatWouldFillTheMemory) {
  const std::vector<Vector2> path = {{0, 0}, {3, 0}};
  EXPECT_EQ(resample(path, 1e-9, 1000).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(resample(path, 0, 1000).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(resample({}, 1, 1000).error().code, ErrorCode::bad_argument);
}

TEST(Resample, RefusesAPathOfOnePlace) {
  const std::vector<Vector2> path = {{1, 2}, {1, 2}, {1, 2}};
  EXPECT_EQ(resample(path, 0.1, 1000).error().message,
            "a path of 3 points that are all the same, (1, 2) mm: must have two different ones");
}

}  // namespace
}  // namespace gravure::texture
