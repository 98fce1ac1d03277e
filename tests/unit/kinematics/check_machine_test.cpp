#include <gtest/gtest.h>

#include <functional>

#include "machines_for_tests.hpp"

namespace gravure::kinematics {
namespace {

Machine good() {
  return xyzac_machine(XyzacSigns::texturing, Vector3::Zero(), test::f_theta());
}

struct Flaw {
  const char* name;
  std::function<void(Machine&)> make;
  ErrorCode code;
  const char* said;
};

const Flaw kFlaws[] = {
    {"no name", [](Machine& m) { m.joints[0].name.clear(); }, ErrorCode::bad_argument, "name of its own"},
    {"a name twice", [](Machine& m) { m.joints[1].name = "X"; }, ErrorCode::bad_argument, "joint X"},
    {"long axis", [](Machine& m) { m.joints[2].axis *= 1.001; }, ErrorCode::out_of_range, "joint Z"},
    {"axis of nan", [](Machine& m) { m.joints[2].axis.x() = std::nan(""); }, ErrorCode::out_of_range, "joint Z"},
    {"crossed limits",
     [](Machine& m) {
       m.joints[3].limits.least = 1;
       m.joints[3].limits.most = -1;
     },
     ErrorCode::bad_argument, "joint A"},
    {"no speed", [](Machine& m) { m.joints[4].limits.max_speed = 0; }, ErrorCode::out_of_range, "max_speed = 0"},
    {"no jerk", [](Machine& m) { m.joints[4].limits.max_jerk = -1; }, ErrorCode::out_of_range, "max_jerk = -1"},
    {"skewed head", [](Machine& m) { m.head.v_axis = Vector3(0, 0.8, 0.6); }, ErrorCode::bad_argument, "right angles"},
    {"no field", [](Machine& m) { m.head.field_mm = 0; }, ErrorCode::out_of_range, "field_mm = 0"},
    {"bits", [](Machine& m) { m.head.resolution_bits = 40; }, ErrorCode::out_of_range, "resolution_bits = 40"},
    {"tilt", [](Machine& m) { m.head.tilt_rad_per_mm = 0.2; }, ErrorCode::out_of_range, "tilt_rad_per_mm = 0.2"},
    {"tilted telecentric", [](Machine& m) { m.head.lens = Lens::telecentric; }, ErrorCode::bad_argument, "telecentric"},
    {"lag", [](Machine& m) { m.head.lag_us = -1; }, ErrorCode::out_of_range, "lag_us = -1"},
    {"galvo speed", [](Machine& m) { m.head.max_speed_mm_s = 0; }, ErrorCode::out_of_range, "max_speed_mm_s = 0"},
    {"joints", [](Machine& m) { m.joints.resize(33); }, ErrorCode::out_of_range, "33 joints"},
};

TEST(CheckMachine, TakesTheMachinesOfThisLibrary) {
  EXPECT_TRUE(check_machine(good()));
  EXPECT_TRUE(check_machine(cylinder_machine(35, test::telecentric())));
  EXPECT_TRUE(check_machine(plane_machine(test::telecentric())));
}

TEST(CheckMachine, RefusesEachFlawByName) {
  for (const Flaw& flaw : kFlaws) {
    Machine machine = good();
    flaw.make(machine);
    const auto result = check_machine(machine);
    ASSERT_FALSE(result) << flaw.name;
    EXPECT_EQ(result.error().code, flaw.code) << flaw.name;
    EXPECT_NE(result.error().message.find(flaw.said), std::string::npos) << flaw.name << ": " << result.error().message;
  }
}

TEST(CheckMachine, FindsJointsByNameOrListsThem) {
  EXPECT_EQ(find_joint(good(), "A").value(), 3U);
  const auto none = find_joint(good(), "B");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("X, Y, Z, A, C"), std::string::npos) << none.error().message;
}

}  // namespace
}  // namespace gravure::kinematics
