#include "gravure/texture/stroke_path.hpp"

#include <gtest/gtest.h>

#include "published_surface.hpp"

namespace gravure::texture {
namespace {

/// Two strokes of 3 and 2 mm, 4 mm apart: the way between them is dark and no length for pulses.
TEST(StrokePath, GoesFromStrokeToStrokeInTheDark) {
  const std::vector<std::vector<Vector2>> strokes = {{{10, 0}, {13, 0}}, {{13, 4}, {12, 4}, {11, 4}}};
  const TexturePath path = stroke_path(strokes, 0.26, 1000).value();
  const std::vector<SurfacePoint> flat = test::on(*expression_surface("0").value(), path.points_mm);
  const std::vector<double> lengths = pulse_lengths_mm(path, flat);
  ASSERT_EQ(path.dark.size(), path.points_mm.size());
  ASSERT_EQ(path.points_mm.size(), 1U + 12 + 15 + 8);
  EXPECT_LT((path.points_mm.front() - Vector2(-1.5, -2)).norm(), 1e-12) << "centred";
  EXPECT_LT((path.points_mm[12] - Vector2(1.5, -2)).norm(), 1e-12);
  EXPECT_LT((path.points_mm[27] - Vector2(1.5, 2)).norm(), 1e-12);
  EXPECT_NEAR(lengths[12], 3, 1e-12);
  EXPECT_NEAR(lengths[27], 3, 1e-12);
  EXPECT_NEAR(lengths.back(), 5, 1e-12);
  for (std::size_t i = 1; i < path.points_mm.size(); ++i) {
    EXPECT_EQ(path.dark[i], i > 12 && i <= 27) << i;
    EXPECT_NEAR((path.points_mm[i] - path.points_mm[i - 1]).norm(), 0.26, 0.014) << i;
  }
}

TEST(StrokePath, RefusesWhatIsNoPath) {
  const std::vector<std::vector<Vector2>> strokes = {{{10, 0}, {13, 0}}};
  EXPECT_EQ(stroke_path({}, 1, 100).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(stroke_path(strokes, 0, 100).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(stroke_path(strokes, 0.001, 100).error().code, ErrorCode::bad_argument);
  const std::vector<std::vector<Vector2>> points = {{{10, 0}}};
  EXPECT_EQ(stroke_path(points, 1, 100).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace gravure::texture
