// Poses computed from the printed equations of [A] and [C2], to the digits given.

#include <gtest/gtest.h>

#include "gravure/motion/five_axis.hpp"
#include "machines_for_tests.hpp"

namespace gravure::kinematics {
namespace {

using test::kPi;
constexpr double kTolerance = 1e-9;

/// A texture point p over a platform point p' with its normal n' -> five stages, galvo and focus offset.
struct TexturePose {
  Vector3 point;
  Vector3 platform;
  Vector3 normal;
  double joints[5];
  double field[3];
};

const TexturePose kTexturePoses[] = {
    {{10, -5, 2},
     {9.5, -4.2, 1.9},
     {.2, -.3, 1},
     {5.574736972064, 7.600279902409, 4.760047594021, 0.346046930889, 0.588002603548},
     {-0.027735009811, 0.853172512217, 0.413917182089}},
    {{-7, 12, -1},
     {-7.5, 11.5, -1.2},
     {-.25, .1, 1},
     {-7.892051872525, 11.160198895445, 1.762236605986, 0.263020345961, -1.951302703907},
     {-0.649933683620, -0.320963303709, 0.120701137396}},
    {{3, 4, .5}, {3.1, 3.7, .6}, {0, 0, 1}, {3.1, -3.7, 0.6, 0, 0}, {-0.1, -0.3, -0.1}},
    {{0, 20, 3},
     {.3, 19, 2.5},
     {0, .4, 1},
     {-0.3, 16.712580435935, 9.377614577941, 0.380506377112, kPi},
     {0.3, 0.742781352708, 0.835629021797}},
};

TEST(PublishedPoses, SevenAxesOfTexturingComeOutToTheLastDigit) {
  const Machine machine = xyzac_machine(XyzacSigns::texturing, Vector3::Zero(), test::telecentric());
  for (const TexturePose& expected : kTexturePoses) {
    const auto pose = inverse(machine, {expected.platform, expected.normal}, {});
    ASSERT_TRUE(pose) << pose.error().message;
    EXPECT_EQ(pose.value().solver, Solver::tilt_turn);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_NEAR(pose.value().joints[i], expected.joints[i], kTolerance) << machine.joints[i].name;
    }
    const auto field = field_of(machine, pose.value().joints, expected.point);
    ASSERT_TRUE(field) << field.error().message;
    EXPECT_NEAR(field.value().u_mm, expected.field[0], kTolerance);
    EXPECT_NEAR(field.value().v_mm, expected.field[1], kTolerance);
    EXPECT_NEAR(field.value().w_mm, expected.field[2], kTolerance);
    const Spot spot = forward(machine, pose.value().joints, field.value());
    EXPECT_LT((spot.position_mm - expected.point).norm(), kTolerance);
    EXPECT_LT((spot.towards_head - expected.normal.normalized()).norm(), kTolerance);
  }
}

TEST(PublishedPoses, TheMatrixOfTexturingIsMirroredNotARotation) {
  const Machine machine = xyzac_machine(XyzacSigns::texturing, Vector3::Zero(), test::telecentric());
  const double a = 0.4;
  const double c = 0.9;
  const JointPositions joints{0, 0, 0, a, c};
  const Jacobian moves = jacobian(machine, joints, {});
  const Eigen::Matrix3d matrix = moves.position.leftCols<3>().transpose();  // M of [A]: its rows are X, Y and Z
  EXPECT_NEAR(matrix.col(0).cross(matrix.col(1)).dot(matrix.col(2)), -1, 1e-14);
  Eigen::Matrix3d printed;
  printed << std::cos(c), std::sin(c), 0,                                   //
      std::cos(a) * std::sin(c), -std::cos(a) * std::cos(c), -std::sin(a),  //
      std::sin(a) * std::sin(c), -std::sin(a) * std::cos(c), std::cos(a);
  EXPECT_LT((matrix - printed).norm(), 1e-14);
  EXPECT_LT((moves.position.rightCols<3>().transpose() - printed).norm(), 1e-14) << "U, V and w move as X, Y and Z do";
}

TEST(PublishedPoses, PostProcessorOfImpellersHasBothBranches) {
  const Machine machine = xyzac_machine(XyzacSigns::post_processor, Vector3::Zero(), test::telecentric());
  const Target target{{30, 10, 5}, Vector3(.3, .4, .8660254)};
  const double expected[2][5] = {{18, 20.0166605, 17.33012702, 30, 36.86989765},
                                 {-18, -20.0166605, 17.33012702, -30, -143.13010235}};
  for (const Branch branch : {Branch::positive, Branch::negative}) {
    const auto pose = inverse(machine, target, {{}, {}, {}, branch});
    ASSERT_TRUE(pose) << pose.error().message;
    for (std::size_t i = 0; i < 5; ++i) {
      const double unit = i < 3 ? 1 : 180 / kPi;
      EXPECT_NEAR(pose.value().joints[i] * unit, expected[branch == Branch::positive ? 0 : 1][i], 2e-7)
          << machine.joints[i].name;
    }
  }
}

TEST(PublishedPoses, AgreeWithTheFiveAxisRewriterOfMotion) {
  SCOPED_TRACE(gravure::test::Dice::note());
  gravure::test::Dice dice(11);
  const Vector3 centre(3, -2, 7);
  const Machine machine = xyzac_machine(XyzacSigns::post_processor, centre, test::telecentric());
  for (int trial = 0; trial < 1000; ++trial) {
    const Vector3 point = 60 * test::direction(dice);
    const Vector3 normal = test::direction(dice);
    const double near = test::real(dice, -20, 20);
    const auto pose = inverse(machine, {point, normal}, {{}, {0, 0, 0, 0, near}, {}, Branch::positive});
    ASSERT_TRUE(pose) << pose.error().message;
    const motion::AxisPose other =
        motion::axes_of({{point.x(), point.y(), point.z()}, {normal.x(), normal.y(), normal.z()}},
                        {centre.x(), centre.y(), centre.z()}, motion::Branch::positive_a, near);
    const JointPositions& joints = pose.value().joints;
    EXPECT_NEAR(joints[0], other.x_mm, 1e-11);
    EXPECT_NEAR(joints[1], other.y_mm, 1e-11);
    EXPECT_NEAR(joints[2], other.z_mm, 1e-11);
    EXPECT_NEAR(joints[3], other.a_rad, 1e-12);
    EXPECT_NEAR(joints[4], other.c_rad, 1e-12);
  }
}

}  // namespace
}  // namespace gravure::kinematics
