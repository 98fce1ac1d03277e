#include "gravure/zones/local_frame.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "dice.hpp"

namespace gravure::zones {
namespace {

/// Cluster 1 of [D]: direction as its table has it, shorter than 1.
const Vector3 kDirection(0.98018, 0.0020, 0.18703);
const Vector3 kOrigin(18.900, 13.328, 91.963);

TEST(LocalFrame, IsThePublishedClusterMadeRightHanded) {
  // The vector is exact for the direction of its third row.
  const Vector3 direction(0.982275128, 0.002004643, 0.187434132);
  const Eigen::Matrix4d h = local_frame(direction, kOrigin).value().matrix();
  const double rows[3][4] = {{-0.002040812, 0.999997918, 0, -13.2894009},
                             {-0.187433741, -0.000382518, 0.982277174, -86.7855598},
                             {0.982275128, 0.002004643, 0.187434132, -35.8287229}};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      EXPECT_NEAR(h(row, column), rows[row][column], column < 3 ? 1e-8 : 5e-7) << row << ", " << column;
    }
  }
  EXPECT_EQ(h.row(3), Eigen::RowVector4d(0, 0, 0, 1));
}

TEST(LocalFrame, OfAShortDirectionIsOrthonormalWhereThePublishedOneIsNot) {
  const LocalFrame frame = local_frame(kDirection, kOrigin).value();
  EXPECT_NEAR(frame.z.norm(), 1, 1e-15);
  EXPECT_NEAR(frame.y.dot(frame.z), 0, 1e-15);
  // [D] eq. 12 to the letter: z as it is, y from it, x = z x y.
  const Vector3 z = kDirection;
  const Vector3 y = (Vector3::UnitZ() - z.z() * z).normalized();
  const Vector3 x = z.cross(y);
  Eigen::Matrix3d literal;
  literal << x, y, z;
  EXPECT_LT(literal.determinant(), -0.99);
  EXPECT_GT(std::abs(y.dot(z)), 1e-4);
}

TEST(LocalFrame, IsRightHandedEverywhere) {
  SCOPED_TRACE(test::Dice::note());
  test::Dice dice(41);
  const auto number = [&dice] { return static_cast<double>(dice.between(-1'000'000, 1'000'000)) / 1'000'000; };
  for (int trial = 0; trial < 3000; ++trial) {
    Vector3 direction(number(), number(), number());
    if (trial % 5 == 0) {
      direction.head<2>() *= std::pow(10, -(trial % 14));  // towards the pole
    }
    if (trial % 97 == 0) {
      direction = Vector3(0, 0, trial % 2 == 0 ? 1 : -1);
    }
    const Vector3 origin(number(), number(), number());
    const LocalFrame frame = local_frame(direction, origin).value();
    Eigen::Matrix3d r;
    r << frame.x, frame.y, frame.z;
    ASSERT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 3e-15);
    ASSERT_NEAR(r.determinant(), 1, 1e-14);
    ASSERT_NEAR(frame.z.dot(direction.normalized()), 1, 1e-15);
    const Vector3 point(number(), number(), number());
    ASSERT_LT((frame.to_part(frame.to_local(point)) - point).norm(), 1e-14);
    ASSERT_LT((frame.matrix() * point.homogeneous() - frame.to_local(point).homogeneous()).norm(), 1e-14);
  }
}

TEST(LocalFrame, TakesItsYFromTheWorkpiecesYAtThePole) {
  const LocalFrame frame = local_frame({0, 0, 2}, Vector3::Zero()).value();
  EXPECT_EQ(frame.x, Vector3::UnitX());
  EXPECT_EQ(frame.y, Vector3::UnitY());
  EXPECT_EQ(local_frame(Vector3::Zero(), Vector3::Zero()).error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace gravure::zones
