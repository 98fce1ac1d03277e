#include "gravure/scan/joint_reach.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "gravure/scan/job_trajectory.hpp"
#include "plans.hpp"

namespace gravure::scan {
namespace {

using kinematics::Joint;
using kinematics::JointKind;
using kinematics::Machine;
using kinematics::Side;
using kinematics::Vector3;
using test::scanner_job;
using test::scanner_plan;

/// A lathe: the axis lies 20 mm below and 3 mm beside the focus at 0, which is 10 mm along U; x counts against U.
Machine lathe() {
  Machine machine;
  machine.head.field_mm = 40;
  machine.head.origin_mm = {10, 0, 0};
  machine.joints = {{"c", JointKind::revolute, Side::workpiece, -Vector3::UnitX(), {0, 3, -20}, {}},
                    {"x", JointKind::prismatic, Side::tool, -Vector3::UnitX(), Vector3::Zero(), {}},
                    {"y", JointKind::prismatic, Side::workpiece, Vector3::UnitY(), Vector3::Zero(), {}},
                    {"z", JointKind::prismatic, Side::tool, Vector3::UnitZ(), Vector3::Zero(), {}}};
  return machine;
}

Machine table() {
  Machine machine;
  machine.head.field_mm = 40;
  machine.joints = {{"x", JointKind::prismatic, Side::tool, Vector3::UnitX(), Vector3::Zero(), {}},
                    {"y", JointKind::prismatic, Side::workpiece, -Vector3::UnitY(), Vector3::Zero(), {}},
                    {"tilt", JointKind::revolute, Side::workpiece, Vector3::UnitX(), Vector3::Zero(), {}}};
  return machine;
}

std::vector<JointReach> reach_of(const Machine& machine, const Plan& plan) {
  const auto reach = joint_reach(machine, plan);
  EXPECT_TRUE(reach) << reach.error().message;
  return reach ? reach.value() : std::vector<JointReach>();
}

TEST(JointReach, PutsTheFocusOverTheLineOfATurningWorkpiece) {
  Job job = scanner_job(Mode::rotary);
  job.scanner.offset_deg = 30;
  const Plan plan = scanner_plan(job);
  const Machine machine = lathe();
  const std::vector<JointReach> reach = reach_of(machine, plan);
  ASSERT_EQ(reach.size(), 4U);
  EXPECT_DOUBLE_EQ(reach[0].most, 0) << "against U: turns the other way";
  EXPECT_DOUBLE_EQ(reach[0].least, -720);
  kinematics::JointPositions joints;
  for (const JointReach& joint : reach) {
    joints.push_back(joint.kind == JointKind::revolute ? 0 : joint.least);
  }
  const kinematics::Spot spot = kinematics::forward(machine, joints, {});
  const double radius_mm = 1.6 / 2 / std::numbers::pi;
  EXPECT_NEAR(spot.position_mm.x(), 149 * 0.008 / 2, 1e-12) << "the middle of the columns";
  EXPECT_NEAR(spot.position_mm.y(), 3, 1e-12) << "over the axis";
  EXPECT_NEAR(spot.position_mm.z(), -20 + radius_mm * std::cos(std::numbers::pi / 6), 1e-12);
}

TEST(JointReach, HoldsEveryPositionOfEveryLine) {
  for (const Mode mode : {Mode::rotary, Mode::helical, Mode::flat}) {
    SCOPED_TRACE(mode_name(mode));
    Job job = scanner_job(mode);
    job.scanner.field_mm = mode == Mode::helical ? 40 : ratio(1, 2);  // bands
    job.scanner.turn_slots = 4000;
    const Plan plan = scanner_plan(job);
    const auto trajectory = JobTrajectory::make(plan);
    ASSERT_TRUE(trajectory) << trajectory.error().message;
    Machine machine = mode == Mode::flat ? table() : lathe();
    machine.head.origin_mm = Vector3::Zero();
    const std::vector<JointReach> reach = reach_of(machine, plan);
    const std::size_t along = mode == Mode::flat ? 0 : 1;
    const double sense = mode == Mode::flat ? 1 : -1;
    double least = 1e9;
    double most = -1e9;
    double least_y = 1e9;
    double most_y = -1e9;
    for (std::int64_t revolution = 0; revolution < plan.job.revolutions; ++revolution) {
      for (std::int64_t line = 0; line < plan.rotary.lines_per_revolution; ++line) {
        for (const std::int64_t slot : {std::int64_t{0}, plan.line.slots - 1}) {
          const auto state = trajectory.value().at({revolution, line}, slot, {});
          ASSERT_TRUE(state) << state.error().message;
          const double x = sense * state.value().joints[mode == Mode::flat ? 0 : 1];
          least = std::min(least, x);
          most = std::max(most, x);
          least_y = std::min(least_y, state.value().joints[1]);
          most_y = std::max(most_y, state.value().joints[1]);
        }
      }
    }
    const double slot_mm = 1e-6;  // the last slot of a line is not its end
    EXPECT_NEAR(reach[along].least, least, slot_mm);
    EXPECT_NEAR(reach[along].most, most, slot_mm);
    if (mode == Mode::flat) {
      EXPECT_NEAR(reach[1].least, least_y, 5e-6);
      EXPECT_NEAR(reach[1].most, most_y, 5e-6);
      EXPECT_LE(reach[1].least, least_y);
      EXPECT_GE(reach[1].most, most_y);
      EXPECT_EQ(reach[2].most, 0) << "nothing turns a panel";
    }
  }
}

TEST(JointReach, CountsTheRampsAtBothEnds) {
  Job job = scanner_job(Mode::helical);
  const std::vector<JointReach> without = reach_of(lathe(), scanner_plan(job));
  job.rotary.limits = {36'000, 360'000, 3'600'000};
  job.carriage.limits = {1'000, 1'000, 100'000};
  job.rotary.start_angle_deg = 90;
  const Plan plan = scanner_plan(job);
  const std::vector<JointReach> with = reach_of(lathe(), plan);
  ASSERT_TRUE(plan.spin && plan.carriage->spin);
  EXPECT_DOUBLE_EQ(with[0].least,
                   without[0].least - to_double(Rational(plan.spin->up.travel + plan.spin->down.travel)));
  EXPECT_DOUBLE_EQ(with[0].most, 0) << "from rest at the encoder index";
  EXPECT_DOUBLE_EQ(with[1].most, without[1].most + to_double(plan.carriage->spin->up.travel));
  EXPECT_DOUBLE_EQ(with[1].least, without[1].least - to_double(plan.carriage->spin->down.travel));
}

TEST(JointReach, RefusesWhatLeavesItsLimitsByNameValueAndLimit) {
  Machine machine = lathe();
  machine.joints[0].limits.least = -720 * std::numbers::pi / 180;
  machine.joints[3].limits.most = -20.5;
  machine.joints[1].limits.most = 9;
  const std::vector<JointReach> reach = reach_of(machine, scanner_plan(scanner_job(Mode::rotary)));
  const auto checked = check_reach(reach);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, ErrorCode::out_of_range);
  EXPECT_EQ(checked.error().message,
            "joint x stands at 9.404 mm in this job: its limits are any to 9 mm\n"
            "joint z stands at -19.7453521 mm in this job: its limits are any to -20.5 mm");
  machine.joints[1].limits.most = 9.5;
  machine.joints[3].limits.most = -19;
  EXPECT_TRUE(check_reach(reach_of(machine, scanner_plan(scanner_job(Mode::rotary)))));
  machine.joints[0].limits.least = -719 * std::numbers::pi / 180;
  EXPECT_FALSE(check_reach(reach_of(machine, scanner_plan(scanner_job(Mode::rotary)))));
}

TEST(JointReach, RefusesTwoJointsInOneDirection) {
  Machine machine = lathe();
  machine.joints.push_back({"z2", JointKind::prismatic, Side::workpiece, Vector3::UnitZ(), Vector3::Zero(), {}});
  const auto reach = joint_reach(machine, scanner_plan(scanner_job(Mode::rotary)));
  ASSERT_FALSE(reach);
  EXPECT_EQ(reach.error().message,
            "joints z and z2 could both be the axis of the focus; describe in this file only the one that is");
}

}  // namespace
}  // namespace gravure::scan
