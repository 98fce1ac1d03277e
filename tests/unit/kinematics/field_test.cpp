#include <gtest/gtest.h>

#include "machines_for_tests.hpp"

namespace gravure::kinematics {
namespace {

TEST(Field, TiltsOutwardsInProportionForFTheta) {
  const ScanHead head = test::f_theta();
  const Vector3 beam = beam_of(head, {6, -8, 0});
  EXPECT_NEAR(std::acos(beam.z()), 0.1, 1e-12);  // 10 mm from the centre, 0.01 rad a mm
  EXPECT_LT(beam.x(), 0) << "towards the head is towards the axis";
  EXPECT_GT(beam.y(), 0);
  EXPECT_EQ(beam_of(test::telecentric(), {6, -8, 0}), Vector3::UnitZ());
}

TEST(Field, OfADefocusedPointFollowsTheTiltedBeam) {
  const ScanHead head = test::f_theta();
  const FieldPoint field{9, 4, -0.7};
  const Vector3 point = Vector3(field.u_mm, field.v_mm, 0) + field.w_mm * beam_of(head, field);
  const auto found = field_of_point(head, point);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_NEAR(found.value().u_mm, 9, 1e-13);
  EXPECT_NEAR(found.value().v_mm, 4, 1e-13);
  EXPECT_NEAR(found.value().w_mm, -0.7, 1e-13);
}

TEST(Field, BeyondWhereBeamsCrossThereIsNone) {
  // The beams of a lens of 100 mm focal length meet 100 mm above the focal plane.
  const auto found = field_of_point(test::f_theta(), {30, 0, 99});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::out_of_range);
}

TEST(Field, SmallerThanNeededIsRefusedWithTheSizeThatWouldDo) {
  EXPECT_TRUE(check_field(test::telecentric(30), {15, -15, 0}));
  const auto refused = check_field(test::telecentric(30), {3, -15.5, 0});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_NE(refused.error().message.find("31"), std::string::npos) << refused.error().message;
}

}  // namespace
}  // namespace gravure::kinematics
