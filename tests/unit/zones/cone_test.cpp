#include "gravure/zones/cone.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "dice.hpp"

namespace gravure::zones {
namespace {

Vector3 random_direction(test::Dice& dice, double spread) {
  const auto number = [&dice] { return static_cast<double>(dice.between(-1'000'000, 1'000'000)) / 1'000'000; };
  return Vector3(spread * number(), spread * number(), 1).normalized();
}

/// By trying every pair and every three.
double smallest_by_force(const std::vector<Vector3>& of) {
  double least = 4;
  const auto offer = [&](const Vector3& axis) {
    if (!axis.allFinite() || axis.norm() < 0.5) {
      return;
    }
    double most = 0;
    for (const Vector3& d : of) {
      most = std::max(most, angle_between(axis, d));
    }
    least = std::min(least, most);
  };
  for (std::size_t i = 0; i < of.size(); ++i) {
    for (std::size_t j = 0; j < of.size(); ++j) {
      offer((of[i] + of[j]).normalized());
      for (std::size_t k = j + 1; k < of.size(); ++k) {
        const Vector3 normal = (of[j] - of[i]).cross(of[k] - of[i]).normalized();
        offer(normal);
        offer(-normal);
      }
    }
  }
  return least;
}

TEST(EnclosingCone, IsTheSmallestOfAll) {
  SCOPED_TRACE(test::Dice::note());
  test::Dice dice(31);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Vector3> directions(static_cast<std::size_t>(dice.between(1, 12)));
    const double spread = trial % 3 == 0 ? 1e-4 : trial % 3 == 1 ? 0.1 : 1.5;
    for (Vector3& direction : directions) {
      direction = random_direction(dice, spread);
    }
    if (dice.coin()) {
      directions.push_back(directions[0]);  // twice the same
    }
    const Cone cone = enclosing_cone(directions).value();
    EXPECT_NEAR(cone.half_angle_rad, smallest_by_force(directions), 1e-12);
    EXPECT_NEAR(cone.axis.norm(), 1, 1e-14);
    for (const Vector3& direction : directions) {
      EXPECT_LE(angle_between(cone.axis, direction), cone.half_angle_rad);
    }
  }
}

TEST(EnclosingCone, OfACircleIsTheCircle) {
  std::vector<Vector3> circle;
  for (int i = 0; i < 360; ++i) {
    const double turn = i * std::numbers::pi / 180;
    circle.push_back({std::sin(0.1) * std::cos(turn), std::sin(0.1) * std::sin(turn), std::cos(0.1)});
  }
  const Cone cone = enclosing_cone(circle).value();
  EXPECT_NEAR(cone.half_angle_rad, 0.1, 1e-12);
  EXPECT_NEAR((cone.axis - Vector3::UnitZ()).norm(), 0, 1e-12);
}

TEST(EnclosingCone, RefusesDirectionsToAllSides) {
  EXPECT_EQ(enclosing_cone({}).error().code, ErrorCode::bad_argument);
  const std::vector<Vector3> opposite{Vector3::UnitX(), -Vector3::UnitX()};
  EXPECT_EQ(enclosing_cone(opposite).error().code, ErrorCode::out_of_range);
  const std::vector<Vector3> corners{Vector3(1, 1, 1).normalized(), Vector3(1, -1, -1).normalized(),
                                     Vector3(-1, 1, -1).normalized(), Vector3(-1, -1, 1).normalized()};
  EXPECT_EQ(enclosing_cone(corners).error().code, ErrorCode::out_of_range);
}

TEST(Angle, IsExactNearZero) {
  const Vector3 near = Vector3(1e-9, 0, 1).normalized();
  EXPECT_NEAR(angle_between(Vector3::UnitZ(), near), 1e-9, 1e-24);  // acos gives 0
  EXPECT_NEAR(angle_between(Vector3::UnitZ(), Vector3(0, 0, -1)), std::numbers::pi, 1e-15);
}

}  // namespace
}  // namespace gravure::zones
