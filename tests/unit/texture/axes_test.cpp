#include "gravure/texture/axes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "dice.hpp"
#include "gravure/kinematics/machines.hpp"

namespace gravure::texture {
namespace {

/// Points of random slopes, some at the pole, some within 1e-9 of it, and C many turns on behind them.
std::vector<SurfacePoint> random_points(test::Dice& dice, std::size_t count) {
  const auto uniform = [&dice](double most) {
    return most * (static_cast<double>(dice.between(-1'000'000'000, 1'000'000'000)) / 1e9);
  };
  std::vector<SurfacePoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double slope = i % 7 == 0 ? 0 : i % 7 == 1 ? 1e-9 : i % 7 == 2 ? 1e-14 : 1.5;
    points[i].position_mm = {uniform(50), uniform(50), uniform(10)};
    points[i].normal = Vector3(uniform(slope), uniform(slope), 1).normalized();
  }
  points[5].normal = Vector3(0, 0.6, 0.8);  // along the axes of the plane
  points[6].normal = Vector3(0, -0.6, 0.8);
  points[12].normal = Vector3(-0.6, 0, 0.8);
  return points;
}

void expect_same(const SevenAxes& closed, const kinematics::Pose& pose, const kinematics::FieldPoint& field,
                 double reach_mm) {
  const double near_mm = 1e-12 * reach_mm;
  EXPECT_NEAR(closed.x_mm, pose.joints[0], near_mm);
  EXPECT_NEAR(closed.y_mm, pose.joints[1], near_mm);
  EXPECT_NEAR(closed.z_mm, pose.joints[2], near_mm);
  EXPECT_NEAR(closed.a_rad, pose.joints[3], 1e-12);
  EXPECT_NEAR(closed.c_rad, pose.joints[4], 1e-12 * std::max(1.0, std::abs(closed.c_rad)));
  EXPECT_NEAR(closed.u_mm, field.u_mm, near_mm);
  EXPECT_NEAR(closed.v_mm, field.v_mm, near_mm);
  EXPECT_NEAR(closed.w_mm, field.w_mm, near_mm);
}

TEST(SevenAxesClosedForm, AreThoseOfTheGenericChainOnEveryBranch) {
  SCOPED_TRACE(test::Dice::note());
  test::Dice dice;
  for (const auto signs : {kinematics::XyzacSigns::texturing, kinematics::XyzacSigns::post_processor}) {
    for (const auto branch : {kinematics::Branch::positive, kinematics::Branch::negative}) {
      const auto machine = kinematics::xyzac_machine(signs, Vector3(3, -20, 7), {});
      const auto stages = random_points(dice, 700);
      const auto targets = random_points(dice, 700);
      const auto axes = seven_axes(machine, targets, stages, branch);
      ASSERT_TRUE(axes) << axes.error().message;
      kinematics::InverseRequest request;
      request.branch = branch;
      for (std::size_t i = 0; i < stages.size() && !testing::Test::HasFailure(); ++i) {
        const auto pose = kinematics::inverse(machine, {stages[i].position_mm, stages[i].normal}, request);
        ASSERT_TRUE(pose) << pose.error().message;
        request.near = pose.value().joints;
        const auto field = kinematics::field_of(machine, request.near, targets[i].position_mm);
        SCOPED_TRACE(testing::Message() << "point " << i);
        expect_same(axes.value()[i], pose.value(), field.value(), 200);
      }
    }
  }
}

TEST(SevenAxesClosedForm, KeepToTheTurnsThatTheLimitsOfCAllow) {
  auto machine = kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, Vector3::Zero(), {});
  machine.joints[4].limits.least = -0.5;
  machine.joints[4].limits.most = 6;
  const std::vector<SurfacePoint> points{{Vector3::Zero(), Vector3(-0.6, 0, 0.8)},
                                         {Vector3::Zero(), Vector3(0, 0.6, 0.8)}};
  const auto axes = seven_axes(machine, points, points);
  ASSERT_TRUE(axes) << axes.error().message;
  EXPECT_NEAR(axes.value()[0].c_rad, 1.5 * 3.14159265358979, 1e-9);  // not -pi / 2
  EXPECT_NEAR(axes.value()[1].c_rad, 3.14159265358979, 1e-9);
}

TEST(SevenAxesClosedForm, RefuseByNameWhatNoAxisReaches) {
  auto machine = kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, Vector3::Zero(), {});
  machine.joints[3].limits.most = 0.1;
  std::vector<SurfacePoint> points{{Vector3::Zero(), Vector3::UnitZ()}, {Vector3(1, 2, 3), Vector3(0.6, 0, 0.8)}};
  const auto steep = seven_axes(machine, points, points);
  ASSERT_FALSE(steep);
  EXPECT_EQ(steep.error().code, ErrorCode::out_of_range);
  EXPECT_NE(steep.error().message.find("point 1"), std::string::npos);
  EXPECT_NE(steep.error().message.find("joint A"), std::string::npos);
  points[0].position_mm.x() = std::nan("");
  EXPECT_EQ(seven_axes(machine, points, points).error().code, ErrorCode::bad_argument);
  machine.head.lens = kinematics::Lens::f_theta;
  EXPECT_EQ(seven_axes(machine, points, points).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace gravure::texture
