#include <gtest/gtest.h>

#include <numbers>

#include "published_surface.hpp"

namespace gravure::texture {
namespace {

TEST(ExpressionSurface, HasTheNormalsOfItsDerivative) {
  const auto surface = test::published_surface();
  std::vector<Vector2> plane;
  for (int i = -20; i <= 20; ++i) {
    plane.emplace_back(i * 0.97, i * i * 0.05 - 11);
  }
  const std::vector<SurfacePoint> points = test::on(*surface, plane);
  ASSERT_EQ(points.size(), plane.size());
  const double w = 2 * std::numbers::pi / 39;
  for (const SurfacePoint& point : points) {
    const double x = point.position_mm.x();
    const double y = point.position_mm.y();
    EXPECT_NEAR(point.position_mm.z(), 2.6 * (std::cos(w * x + 0.3) + std::cos(w * y + 1.1)), 1e-12);
    const Vector3 normal = Vector3(2.6 * w * std::sin(w * x + 0.3), 2.6 * w * std::sin(w * y + 1.1), 1).normalized();
    EXPECT_LT((point.normal - normal).norm(), 1e-10);
  }
}

TEST(ExpressionSurface, NamesThePlaceOfWhatDoesNotParse) {
  const auto surface = expression_surface("2*(x+");
  ASSERT_FALSE(surface);
  EXPECT_EQ(surface.error().code, ErrorCode::bad_argument);
  EXPECT_NE(surface.error().message.find("character"), std::string::npos);
  EXPECT_FALSE(expression_surface("x = 3"));
  EXPECT_FALSE(expression_surface("x, y"));
  EXPECT_TRUE(expression_surface("x <= 3 ? 1 : 0"));
  EXPECT_FALSE(expression_surface("z + 1"));
  EXPECT_FALSE(expression_surface(""));
  EXPECT_FALSE(expression_surface(std::string(5000, '1')));
}

TEST(ExpressionSurface, NamesThePointWhereItIsNotFinite) {
  const auto surface = expression_surface("sqrt(x)").value();
  std::vector<SurfacePoint> points(2);
  const std::vector<Vector2> plane = {{1, 0}, {-1, 2}};
  const Result<void> projected = surface->project(plane, points);
  ASSERT_FALSE(projected);
  EXPECT_EQ(projected.error().code, ErrorCode::out_of_range);
  EXPECT_NE(projected.error().message.find("x = -1 mm, y = 2 mm"), std::string::npos);
}

}  // namespace
}  // namespace gravure::texture
