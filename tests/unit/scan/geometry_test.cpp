#include <gtest/gtest.h>

#include <functional>

#include "roller.hpp"

namespace gravure::scan {
namespace {

TEST(LineTiming, IsTakenFromAPlan) {
  Plan plan;
  plan.clock.fpga_hz = 164'000'000;
  plan.clock.ticks_per_slot = 82;
  plan.line.slots = 5400;
  plan.line.slots_per_microvector = 20;
  plan.line.pixels = 3500;
  plan.line.forward_first_slot = 950;
  plan.line.reverse_first_slot = 962;
  plan.line.offset_slots = 12;
  plan.line.pixel_pitch_um = 8;
  plan.rotary.circumference_um = pi() * Rational(70'000);
  plan.rotary.lines_per_revolution = 27'489;
  const LineTiming timing = line_timing(plan);
  EXPECT_TRUE(check_timing(timing));
  EXPECT_EQ(timing.ticks(), 442'800);
  EXPECT_EQ(timing.slot_of_pixel(Direction::forward, 0), 950);
  EXPECT_EQ(timing.slot_of_pixel(Direction::reverse, 0), 962 + 3499);
  EXPECT_DOUBLE_EQ(timing.slot_s(), 0.5e-6);
  const CylinderLines lines = cylinder_lines(plan, 15);
  EXPECT_DOUBLE_EQ(lines.diameter_mm, 70);
  EXPECT_EQ(lines.lines_per_revolution, 27'489);
  EXPECT_DOUBLE_EQ(lines.pixel_pitch_mm, 0.008);
  EXPECT_EQ(lines.offset_deg, 15);
}

TEST(LineTiming, OutsideItsRangesIsRefusedByName) {
  struct Flaw {
    const char* field;
    std::function<void(LineTiming&)> make;
  };
  const Flaw flaws[] = {
      {"fpga_hz", [](LineTiming& t) { t.fpga_hz = 0; }},
      {"ticks_per_slot", [](LineTiming& t) { t.ticks_per_slot = 0; }},
      {"slots = ", [](LineTiming& t) { t.slots = 0; }},
      {"slots = ", [](LineTiming& t) { t.slots = 5401; }},
      {"slots_per_microvector", [](LineTiming& t) { t.slots_per_microvector = 0; }},
      {"pixels", [](LineTiming& t) { t.pixels = 0; }},
      {"forward_first_slot", [](LineTiming& t) { t.forward_first_slot = 1901; }},
      {"reverse_first_slot", [](LineTiming& t) { t.reverse_first_slot = -1; }},
      {"offset_slots", [](LineTiming& t) { t.offset_slots = 951; }},
  };
  for (const Flaw& flaw : flaws) {
    LineTiming timing = test::roller_timing();
    flaw.make(timing);
    const auto result = check_timing(timing);
    ASSERT_FALSE(result) << flaw.field;
    EXPECT_NE(result.error().message.find(flaw.field), std::string::npos) << result.error().message;
  }
}

TEST(LineGeometry, OutsideItsRangesIsRefusedByName) {
  struct Flaw {
    const char* field;
    std::function<void(CylinderLines&)> make;
  };
  const Flaw flaws[] = {
      {"diameter_mm", [](CylinderLines& l) { l.diameter_mm = 0; }},
      {"pixel_pitch_mm", [](CylinderLines& l) { l.pixel_pitch_mm = -1; }},
      {"lines_per_revolution", [](CylinderLines& l) { l.lines_per_revolution = 0; }},
      {"offset_deg", [](CylinderLines& l) { l.offset_deg = 86; }},
      {"offset_deg", [](CylinderLines& l) { l.offset_deg = std::nan(""); }},
      {"carriage_mm_per_line", [](CylinderLines& l) { l.carriage_mm_per_line = 1e4; }},
  };
  for (const Flaw& flaw : flaws) {
    CylinderLines lines = test::roller_lines();
    flaw.make(lines);
    const auto result = cylinder_geometry(test::roller_timing(), lines, test::roller_head());
    ASSERT_FALSE(result) << flaw.field;
    EXPECT_NE(result.error().message.find(flaw.field), std::string::npos) << result.error().message;
  }
  EXPECT_FALSE(plane_geometry(test::roller_timing(), {0, 0.008}, test::roller_head()));
  EXPECT_FALSE(plane_geometry(test::roller_timing(), {0.008, 0}, test::roller_head()));
}

}  // namespace
}  // namespace gravure::scan
