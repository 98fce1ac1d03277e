#include "gravure/twin/verify_path.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "gravure/emulator/emulated_device.hpp"
#include "gravure/formats/grv.hpp"
#include "grv_support.hpp"
#include "path_support.hpp"

namespace gravure {
namespace {

using grv_test::Folder;
using path_test::eased_line;
using path_test::request;
using test::all_pulses;
using test::SampledMotion;

DeviceFactory emulated() {
  return [](PinObserver& observer) { return std::make_unique<emulator::EmulatedDevice>(&observer); };
}

/// A straight line 20 mm long on a plane 3.5 mm high: X takes half of it, U the rest.
struct Case {
  std::vector<PathInstant> instants;
  std::vector<PathTarget> targets;
  PathPulses pulses = all_pulses(0.01, 2000);
  PathPlanRequest wanted = request(10);

  Case() {
    for (PathInstant instant : eased_line(20, 3000)) {
      const double x = instant.along_mm;
      instant.axes = {x / 2, 0, 3.5, 0, 0, x / 2, 0};
      instants.push_back(instant);
    }
    targets = {{0, {0, 0, 3.5}, {0, 0, 1}}, {20, {20, 0, 3.5}, {0, 0, 1}}};
    wanted.path.max_landing_um = ratio(1, 2);
    wanted.path.max_focus_offset_um = Rational(1);
    wanted.path.max_incidence_deg = ratio(1, 100);
    wanted.path.max_displacement_mm = Rational(11);
    // 10 mm in 150 ms with 10 s^3 - 15 s^4 + 6 s^5: 1.875 d / T, 5.7735 d / T^2, 60 d / T^3.
    wanted.path.axes[0].limits = {Rational(125), Rational(2567), Rational(177'800)};
    wanted.path.axes[0].most = Rational(10);
    wanted.path.axes[0].least = Rational(0);
  }

  Result<PathReport> run(const VerifyPathOptions& options = {}) const {
    const Folder folder;
    const SampledMotion motion(instants);
    ProgramHeader header;
    GRAVURE_TRY(header.plan,
                make_path_plan(wanted, motion.instants(), pulses.count, static_cast<std::int64_t>(targets.size())));
    GRAVURE_TRY(const auto sink, create_grv(folder.file("p.grv"), 1, header.plan.rotary.lines_per_revolution,
                                            header.line_bytes(), {.focus_axis = header.plan.path->has_focus_axis()}));
    GRAVURE_CHECK(compile_path(header, motion, pulses, targets, *sink));
    GRAVURE_TRY(const auto source, open_grv(folder.file("p.grv")));
    return verify_path(*source, emulated(), options);
  }
};

void expect_one_violation(const Result<PathReport>& report, const std::string& says) {
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report.value().violations.size(), 1U) << says;
  EXPECT_NE(report.value().violations[0].find(says), std::string::npos) << report.value().violations[0];
}

TEST(VerifyPath, FindsAMotionWithinItsLimits) {
  const Case line;
  const auto report = line.run({.wanted = &line.pulses});
  ASSERT_TRUE(report) << report.error().message;
  const PathReport& path = report.value();
  EXPECT_EQ(path.violations, std::vector<std::string>());
  EXPECT_EQ(path.lines, 3000);
  EXPECT_EQ(path.ticks, std::int64_t{3000} * 8200);
  EXPECT_EQ(path.fired, 2000);
  EXPECT_LE(path.spacing_um.max, path.half_slot_um);
  EXPECT_NEAR(path.landing_um.max, path.spacing_um.max, 1e-4);
  EXPECT_LT(path.focus_offset_um.max, 1e-6);
  EXPECT_NEAR(path.axes[0].max_speed, 10 * 1.875 / 0.15, 1e-3);
  EXPECT_NEAR(path.axes[0].max_jerk, 60 * 10 / (0.15 * 0.15 * 0.15), 600);
}

TEST(VerifyPath, NamesEachLimitThatIsBrokenOnce) {
  Case slow;
  slow.wanted.path.axes[0].limits.max_jerk = Rational(170'000);
  expect_one_violation(slow.run(), "axis X: jerk 17");
  Case narrow;
  narrow.wanted.path.axes[0].most = ratio(99, 10);
  expect_one_violation(narrow.run(), "axis X: position 10 mm at 0.1");
  Case low;
  low.wanted.path.max_displacement_mm = Rational(9);
  expect_one_violation(low.run(), "galvo 9.99");
}

TEST(VerifyPath, SeesAnAxisThatStandsElsewhere) {
  Case high;  // the table tells of another plane than the path
  for (PathTarget& target : high.targets) {
    target.position_mm[2] += 0.002;
  }
  expect_one_violation(high.run(), "focus offset 2 um");
  Case tilted;
  for (PathTarget& target : tilted.targets) {
    target.normal = {0, 0.6, 0.8};
  }
  expect_one_violation(tilted.run(), "incidence 36.86");
  Case off;
  for (PathInstant& instant : off.instants) {
    instant.axes[6] += 0.002;
  }
  expect_one_violation(off.run(), "landing 2.");
}

/// Z stays while the surface rises by 0.2 mm: W takes it up, or the light is out of focus by as much.
TEST(VerifyPath, FindsFocusWhereTheFocusAxisPutsIt) {
  Case rising;
  rising.targets = {{0, {0, 0, 3.5}, {0, 0, 1}}, {20, {20, 0, 3.7}, {0, 0, 1}}};
  expect_one_violation(rising.run(), "focus offset 199.9");
  for (PathInstant& instant : rising.instants) {
    instant.axes[kFocusAxis] = 0.01 * instant.along_mm;
  }
  expect_one_violation(rising.run(), "focus offset 199.9");  // the plan has no W
  rising.wanted = path_test::with_focus_axis(rising.wanted, 0, 1);
  // 0.2 mm as X of FindsAMotionWithinItsLimits goes 10 mm.
  rising.wanted.path.axes[kFocusAxis].limits = {ratio(25, 10), Rational(52), Rational(3560)};
  const auto report = rising.run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report.value().violations, std::vector<std::string>());
  EXPECT_LT(report.value().focus_offset_um.max, 0.0101 * report.value().half_slot_um);  // where it rises meanwhile
  ASSERT_EQ(report.value().axes.size(), kPathAxes.size());
  EXPECT_NEAR(report.value().axes[kFocusAxis].most, 0.2, 1e-9);
  EXPECT_NEAR(report.value().axes[kFocusAxis].max_speed, 0.2 * 1.875 / 0.15, 1e-4);
  Case low = rising;
  low.wanted.path.axes[kFocusAxis].most = ratio(199, 1000);
  expect_one_violation(low.run(), "axis W: position 0.2 mm");
  Case slow = rising;
  slow.wanted.path.axes[kFocusAxis].limits.max_speed = ratio(24, 10);
  expect_one_violation(slow.run(), "axis W: speed 2.5 mm/s");
  Case soft = rising;
  soft.wanted.path.axes[kFocusAxis].limits.max_jerk = Rational(3400);
  expect_one_violation(soft.run(), "axis W: jerk 3");
}

TEST(VerifyPath, SeesASetPointThatIsOff) {
  Case line;
  line.instants[1500].axes[0] += 1e-6;
  const auto report = line.run();
  ASSERT_TRUE(report);
  ASSERT_FALSE(report.value().violations.empty());
  EXPECT_NE(report.value().violations.back().find("jerk"), std::string::npos);
  EXPECT_NE(report.value().violations.back().find("line 1"), std::string::npos);
}

TEST(VerifyPath, SeesPulsesThatShouldBeDarkOrAreMissing) {
  Case line;
  PathPulses other = line.pulses;
  line.pulses.bits[10] = std::byte{0xEF};
  expect_one_violation(line.run({.wanted = &other}), "1 wanted pulses do not fire, the first is number 83");
  std::swap(line.pulses, other);
  expect_one_violation(line.run({.wanted = &other}), "1 pulses fire that are to stay dark");
}

/// A corner that a spot comes to quickly: its last pulse comes in the first slot of the period in which it hardly
/// moves.
TEST(VerifyPath, TakesAPulseLateByHalfASlotOfThePeriodBefore) {
  Case corner;
  corner.wanted.laser.pulse_divider = 410;
  corner.wanted.servo_period_us = 100;
  corner.instants.clear();
  for (const double along_mm : {0.0, 0.0312065, 0.0651065, 0.0662342, 0.0820634, 0.13, 0.13, 0.13}) {
    PathInstant instant;
    instant.axes = {along_mm / 2, 0, 3.5, 0, 0, along_mm / 2, 0};
    instant.along_mm = along_mm;
    corner.instants.push_back(instant);
  }
  corner.pulses = all_pulses(0.01, 13);
  const auto report = corner.run({.wanted = &corner.pulses});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report.value().fired, 13);
  EXPECT_EQ(report.value().misplaced, 0);
  EXPECT_EQ(report.value().missing, 0);
}

TEST(VerifyPath, PutsEveryPulseOnTheWorkpiece) {
  const Case line;
  std::int64_t next = 0;
  VerifyPathOptions options;
  options.landed = [&next](const LandedPulse& landed) -> Result<void> {
    EXPECT_EQ(landed.pulse, next);
    EXPECT_NEAR(landed.spot.position_mm.x(), 0.01 * (static_cast<double>(next) + 0.5), 1e-4);
    EXPECT_NEAR(landed.spot.position_mm.z(), 3.5, 1e-9);
    ++next;
    return {};
  };
  ASSERT_TRUE(line.run(options));
  EXPECT_EQ(next, 2000);
}

}  // namespace
}  // namespace gravure
