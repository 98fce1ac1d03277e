#include <gtest/gtest.h>

#include "machines_for_tests.hpp"

namespace gravure::kinematics {
namespace {

/// Central differences of forward(), joint by joint, then U, V, w.
Jacobian by_differences(const Machine& machine, const JointPositions& joints, const FieldPoint& field) {
  constexpr double kStep = 1e-5;
  const auto count = static_cast<Eigen::Index>(joints.size());
  Jacobian result;
  result.position.resize(3, count + 3);
  result.towards_head.resize(3, count + 3);
  for (Eigen::Index k = 0; k < count + 3; ++k) {
    Spot spots[2];
    for (int side = 0; side < 2; ++side) {
      const double step = side == 0 ? -kStep : kStep;
      JointPositions moved = joints;
      FieldPoint point = field;
      if (k < count) {
        moved[static_cast<std::size_t>(k)] += step;
      } else {
        (k == count ? point.u_mm : k == count + 1 ? point.v_mm : point.w_mm) += step;
      }
      spots[side] = forward(machine, moved, point);
    }
    result.position.col(k) = (spots[1].position_mm - spots[0].position_mm) / (2 * kStep);
    result.towards_head.col(k) = (spots[1].towards_head - spots[0].towards_head) / (2 * kStep);
  }
  return result;
}

TEST(Jacobian, IsTheDerivativeOfForwardForAnyChain) {
  SCOPED_TRACE(gravure::test::Dice::note());
  gravure::test::Dice dice(21);
  for (int trial = 0; trial < 500; ++trial) {
    const Machine machine = test::random_chain(dice, static_cast<int>(dice.between(0, 7)));
    const JointPositions joints = test::random_joints(dice, machine);
    const bool is_centre = trial % 10 == 0;  // where the slope of an f-theta beam has a formula of its own
    const FieldPoint field{is_centre ? 0 : test::real(dice, -10, 10), is_centre ? 0 : test::real(dice, -10, 10),
                           test::real(dice, -2, 2)};
    const Jacobian exact = jacobian(machine, joints, field);
    const Jacobian differences = by_differences(machine, joints, field);
    EXPECT_LT((exact.position - differences.position).norm(), 2e-6) << "trial " << trial;
    EXPECT_LT((exact.towards_head - differences.towards_head).norm(), 1e-7) << "trial " << trial;
  }
}

}  // namespace
}  // namespace gravure::kinematics
