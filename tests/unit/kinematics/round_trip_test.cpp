#include <gtest/gtest.h>

#include <algorithm>

#include "machines_for_tests.hpp"

namespace gravure::kinematics {
namespace {

constexpr double kExact = 1e-9;  // mm
using gravure::test::Dice;

FieldPoint random_field(Dice& dice) {
  return {test::real(dice, -14, 14), test::real(dice, -14, 14), test::real(dice, -1, 1)};
}

/// The pose leads back to the target, whichever pose it is.
void expect_reaches(const Machine& machine, const Pose& pose, const Spot& wanted, bool with_direction) {
  const Spot spot = forward(machine, pose.joints, pose.field);
  EXPECT_LT((spot.position_mm - wanted.position_mm).norm(), kExact);
  if (with_direction) {
    EXPECT_LT((spot.towards_head - wanted.towards_head).norm(), kExact);
  }
}

void expect_same(const JointPositions& found, const JointPositions& meant, double tolerance) {
  ASSERT_EQ(found.size(), meant.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], meant[i], tolerance) << "joint " << i;
  }
}

TEST(RoundTrip, OfXyzacFindsTheJointsWithTheirTurns) {
  SCOPED_TRACE(Dice::note());
  Dice dice(31);
  for (int trial = 0; trial < 20'000; ++trial) {
    const auto signs = dice.coin() ? XyzacSigns::texturing : XyzacSigns::post_processor;
    const Machine machine =
        xyzac_machine(signs, 5 * test::direction(dice), dice.coin() ? test::telecentric() : test::f_theta());
    const bool is_positive = dice.coin();
    const double tilt = test::real(dice, 0.2, 3.0);
    const JointPositions joints{test::real(dice, -100, 100), test::real(dice, -100, 100), test::real(dice, -50, 50),
                                is_positive ? tilt : -tilt, test::real(dice, -20, 20)};
    const FieldPoint field{test::real(dice, -9, 9), test::real(dice, -9, 9), test::real(dice, -1, 1)};
    const Spot spot = forward(machine, joints, field);
    InverseRequest request{field, joints, {}, is_positive ? Branch::positive : Branch::negative};
    request.near[4] += test::real(dice, -3, 3);  // less than half a turn off
    request.near[0] = 0;
    const auto pose = inverse(machine, {spot.position_mm, 7 * spot.towards_head}, request);
    ASSERT_TRUE(pose) << pose.error().message;
    ASSERT_EQ(pose.value().solver, Solver::tilt_turn);
    expect_reaches(machine, pose.value(), spot, true);
    expect_same(pose.value().joints, joints, 1e-8);
  }
}

TEST(RoundTrip, OfCylindersHoldsOffAxisAndFarRoundTheTurns) {
  SCOPED_TRACE(Dice::note());
  Dice dice(32);
  for (int trial = 0; trial < 20'000; ++trial) {
    const double radius = trial % 2 == 0 ? test::real(dice, 20, 150) : test::real(dice, 0.5, 1.5);
    const double offset = test::real(dice, -1.2, 1.2);
    const ScanHead head = dice.coin() ? test::telecentric(400) : test::f_theta(100);
    const Machine machine = cylinder_machine(radius * std::cos(offset), head);
    const double v = std::clamp(radius * std::sin(offset), -40.0, 40.0);
    const FieldPoint field{test::real(dice, -14, 14), v, 0};
    const bool lifts = dice.coin();
    const JointPositions joints{test::real(dice, -1000, 1000), test::real(dice, -500, 500),
                                lifts ? test::real(dice, -0.1, 0.1) * radius : 0};
    const Spot spot = forward(machine, joints, field);
    if (spot.position_mm.tail<2>().norm() < 1.05 * std::abs(v) + 0.1 * radius) {
      continue;  // nearly tangential: both branches meet there
    }
    InverseRequest request{field, joints, {}, Branch::positive};
    request.near[0] += test::real(dice, -3, 3);
    if (!lifts) {
      request.held = {2};  // then the distance from focus is an outcome, here 0
    }
    const auto pose = inverse(machine, {spot.position_mm, {}}, request);
    ASSERT_TRUE(pose) << pose.error().message;
    ASSERT_EQ(pose.value().solver, Solver::cylinder);
    expect_reaches(machine, pose.value(), spot, false);
    expect_same(pose.value().joints, joints, 1e-8);
    EXPECT_NEAR(pose.value().field.w_mm, 0, 1e-8);
  }
}

TEST(RoundTrip, OfPlanesIsExactWithAndWithoutFocusAxis) {
  SCOPED_TRACE(Dice::note());
  Dice dice(33);
  for (int trial = 0; trial < 5'000; ++trial) {
    const Machine machine = plane_machine(dice.coin() ? test::telecentric() : test::f_theta());
    const bool lifts = dice.coin();
    const JointPositions joints{test::real(dice, -500, 500), test::real(dice, -500, 500),
                                lifts ? test::real(dice, -20, 20) : 0};
    const FieldPoint field = random_field(dice);
    const Spot spot = forward(machine, joints, field);
    InverseRequest request{field, {}, {}, Branch::positive};
    if (!lifts) {
      request.held = {2};
    }
    const auto pose = inverse(machine, {spot.position_mm, {}}, request);
    ASSERT_TRUE(pose) << pose.error().message;
    ASSERT_EQ(pose.value().solver, Solver::linear);
    expect_reaches(machine, pose.value(), spot, true);
    expect_same(pose.value().joints, joints, 1e-9);
    EXPECT_NEAR(pose.value().field.w_mm, field.w_mm, 1e-9);
  }
}

TEST(RoundTrip, OfAnyOtherChainIsFoundByNewtonFromNearby) {
  SCOPED_TRACE(Dice::note());
  Dice dice(34);
  int solved = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Machine machine = test::random_chain(dice, 6);
    const JointPositions joints = test::random_joints(dice, machine);
    const FieldPoint field{test::real(dice, -5, 5), test::real(dice, -5, 5), test::real(dice, -1, 1)};
    const Spot spot = forward(machine, joints, field);
    InverseRequest request{field, joints, {}, Branch::positive};
    for (double& position : request.near) {
      position += test::real(dice, -0.05, 0.05);
    }
    const auto pose = inverse(machine, {spot.position_mm, spot.towards_head}, request);
    // A chain short of revolute joints may not be able to turn into the direction from where the search starts.
    if (pose && pose.value().solver == Solver::numeric) {
      expect_reaches(machine, pose.value(), spot, true);
      ++solved;
    }
  }
  EXPECT_GT(solved, 300);
}

TEST(RoundTrip, OfTheGalvoAloneIsExactForAnyChain) {
  SCOPED_TRACE(Dice::note());
  Dice dice(35);
  for (int trial = 0; trial < 5'000; ++trial) {
    const Machine machine = test::random_chain(dice, 5);
    const JointPositions joints = test::random_joints(dice, machine);
    const FieldPoint field = random_field(dice);
    const auto found = field_of(machine, joints, forward(machine, joints, field).position_mm);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_NEAR(found.value().u_mm, field.u_mm, kExact);
    EXPECT_NEAR(found.value().v_mm, field.v_mm, kExact);
    EXPECT_NEAR(found.value().w_mm, field.w_mm, kExact);
  }
}

TEST(RoundTrip, OfACylinderSeesTheOtherSideToo) {
  const Machine machine = cylinder_machine(35, test::telecentric(100));
  const FieldPoint field{1, 10, 0};
  const Vector3 point(4, 0, 35);
  const auto near_side = inverse(machine, {point, {}}, {field, {}, {2}, Branch::positive});
  const auto far_side = inverse(machine, {point, {}}, {field, {}, {2}, Branch::negative});
  ASSERT_TRUE(near_side && far_side);
  EXPECT_NEAR(near_side.value().field.w_mm, std::sqrt(35.0 * 35 - 100) - 35, kExact);
  EXPECT_NEAR(far_side.value().field.w_mm, -std::sqrt(35.0 * 35 - 100) - 35, kExact);
  EXPECT_NEAR(near_side.value().joints[0], -std::asin(10.0 / 35), 1e-12);
}

}  // namespace
}  // namespace gravure::kinematics
