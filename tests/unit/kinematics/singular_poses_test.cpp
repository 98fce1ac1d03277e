#include <gtest/gtest.h>

#include "machines_for_tests.hpp"

namespace gravure::kinematics {
namespace {

using test::kPi;

TEST(SingularPoses, KeepTheTurningAxisWhereTheTiltIsZero) {
  const Machine machine = xyzac_machine(XyzacSigns::texturing, Vector3::Zero(), test::telecentric());
  for (const double c : {0.0, 1.25, -17.5}) {
    const auto pose = inverse(machine, {{3, 4, .5}, Vector3(0, 0, 1)}, {{}, {0, 0, 0, 0.3, c}, {}, Branch::positive});
    ASSERT_TRUE(pose) << pose.error().message;
    EXPECT_TRUE(pose.value().is_singular);
    EXPECT_EQ(pose.value().joints[4], c);
    EXPECT_NEAR(pose.value().joints[3], 0, 1e-15);
    EXPECT_LT((forward(machine, pose.value().joints, {}).position_mm - Vector3(3, 4, .5)).norm(), 1e-12);
  }
}

TEST(SingularPoses, UpsideDownKeepsTheTurningAxisToo) {
  const Machine machine = xyzac_machine(XyzacSigns::post_processor, Vector3::Zero(), test::telecentric());
  const auto pose = inverse(machine, {{3, 4, .5}, Vector3(0, 0, -1)}, {{}, {0, 0, 0, 0, 0.75}, {}, Branch::positive});
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_TRUE(pose.value().is_singular);
  EXPECT_EQ(pose.value().joints[4], 0.75);
  EXPECT_NEAR(pose.value().joints[3], kPi, 1e-12);
}

TEST(SingularPoses, DirectionsStayExactRightUpToThePole) {
  const Machine machine = xyzac_machine(XyzacSigns::texturing, Vector3::Zero(), test::telecentric());
  for (double tilt = 1e-2; tilt > 1e-14; tilt /= 3) {
    const Vector3 normal(std::sin(tilt) * std::cos(0.4), std::sin(tilt) * std::sin(0.4), std::cos(tilt));
    const auto pose = inverse(machine, {{80, -60, 10}, normal}, {});
    ASSERT_TRUE(pose) << pose.error().message;
    EXPECT_EQ(pose.value().is_singular, tilt < 1e-12) << tilt;
    const Spot spot = forward(machine, pose.value().joints, {});
    EXPECT_LT((spot.towards_head - normal).norm(), tilt < 1e-12 ? 1e-12 : 1e-15) << tilt;
    EXPECT_LT((spot.position_mm - Vector3(80, -60, 10)).norm(), 1e-12) << tilt;
  }
}

TEST(SingularPoses, TurnsAccumulateAlongAPathRoundThePole) {
  const Machine machine = xyzac_machine(XyzacSigns::texturing, Vector3::Zero(), test::telecentric());
  JointPositions near(5, 0.0);
  constexpr int kSteps = 1000;
  for (int step = 0; step <= kSteps; ++step) {
    const double around = 6 * kPi * step / kSteps;  // three turns
    const Vector3 normal(0.3 * std::sin(around), -0.3 * std::cos(around), 1);
    const auto pose = inverse(machine, {{1, 2, 3}, normal}, {{}, near, {}, Branch::positive});
    ASSERT_TRUE(pose) << pose.error().message;
    EXPECT_NEAR(pose.value().joints[4], around, 1e-12);
    near = pose.value().joints;
  }
}

TEST(SingularPoses, HalfATurnEitherWayTakesTheLargerAngle) {
  EXPECT_DOUBLE_EQ(nearest_turn(kPi, 0), kPi);
  EXPECT_DOUBLE_EQ(nearest_turn(-kPi, 0), kPi);
  EXPECT_DOUBLE_EQ(nearest_turn(0.5, 20), 0.5 + 6 * kPi);
  EXPECT_DOUBLE_EQ(nearest_turn(0.5, -20), 0.5 - 6 * kPi);
}

TEST(SingularPoses, APointOnTheCylindersAxisKeepsTheRotaryAxis) {
  const Machine machine = cylinder_machine(0, test::telecentric());
  const auto pose = inverse(machine, {{12, 0, 0}, {}}, {{}, {2.5, 0, 0}, {}, Branch::positive});
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_TRUE(pose.value().is_singular);
  EXPECT_EQ(pose.value().joints[0], 2.5);
  EXPECT_NEAR(pose.value().joints[1], 12, 1e-12);
}

TEST(SingularPoses, TheTurnWithinTheLimitsIsTaken) {
  Machine machine = cylinder_machine(35, test::telecentric());
  machine.joints[0].limits.least = 0;
  machine.joints[0].limits.most = 2 * kPi;
  const Vector3 point = forward(machine, JointPositions{-0.5, 0, 0}, {}).position_mm;
  const auto pose = inverse(machine, {point, {}}, {});
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_NEAR(pose.value().joints[0], 2 * kPi - 0.5, 1e-12);
  machine.joints[0].limits.most = 1.0;
  const auto refused = inverse(machine, {point, {}}, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_NE(refused.error().message.find("joint c"), std::string::npos) << refused.error().message;
}

TEST(SingularPoses, WhatCannotBeReachedIsRefused) {
  const Machine cylinder = cylinder_machine(35, test::telecentric(100));
  const auto beside = inverse(cylinder, {{0, 0, 35}, {}}, {{0, 40, 0}, {}, {}, Branch::positive});
  ASSERT_FALSE(beside);
  EXPECT_NE(beside.error().message.find("40"), std::string::npos) << beside.error().message;

  const Machine plane = plane_machine(test::telecentric());
  const auto tilted = inverse(plane, {{0, 0, 0}, Vector3(0.1, 0, 1)}, {});
  ASSERT_FALSE(tilted);
  EXPECT_EQ(tilted.error().code, ErrorCode::out_of_range);

  const auto held = inverse(plane, {{0, 0, 0}, {}}, {{}, {}, {0, 1, 2}, Branch::positive});
  ASSERT_FALSE(held);
  EXPECT_EQ(held.error().code, ErrorCode::bad_argument);

  EXPECT_FALSE(inverse(plane, {{0, 0, 0}, {}}, {{}, {1, 2}, {}, Branch::positive}));
  EXPECT_FALSE(inverse(plane, {{0, 0, 0}, {}}, {{}, {}, {3}, Branch::positive}));
  EXPECT_FALSE(inverse(plane, {{0, 0, 0}, Vector3::Zero()}, {}));
  EXPECT_FALSE(inverse(plane, {{0, 0, std::nan("")}, {}}, {}));
}

}  // namespace
}  // namespace gravure::kinematics
