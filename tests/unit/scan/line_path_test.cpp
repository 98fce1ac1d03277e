#include <gtest/gtest.h>

#include "roller.hpp"

namespace gravure::scan {
namespace {

using test::roller_geometry;
using test::roller_head;
using test::roller_timing;

/// A timing with so many dark slots, the window in the middle.
LineTiming with_turn(std::int64_t turn_slots) {
  LineTiming timing = roller_timing();
  timing.slots_per_microvector = 1;
  timing.slots = timing.pixels + turn_slots;
  timing.forward_first_slot = turn_slots / 2;
  timing.reverse_first_slot = turn_slots - turn_slots / 2;
  return timing;
}

TEST(LinePath, RunsAtConstantSpeedOverTheMarkingWindow) {
  const LineTiming timing = roller_timing();
  const LinePath path = LinePath::plan(timing, roller_geometry(), true).value();
  for (std::int64_t pixel = 0; pixel < timing.pixels; ++pixel) {
    const double u = -13.996 + 0.008 * static_cast<double>(pixel);
    for (const Direction direction : {Direction::forward, Direction::reverse}) {
      const auto slot = static_cast<double>(timing.slot_of_pixel(direction, pixel));
      ASSERT_NEAR(path.at(direction, slot).u_mm, u, 1e-12) << pixel;
    }
  }
}

/// Walks over two lines and the seam to the next two in quarter slots: position, speed and acceleration make no jump
/// that the limits do not allow.
void expect_within_limits(const LinePath& path, double a_max, double j_max) {
  constexpr double kStep = 0.25;
  const double h = kStep * path.timing().slot_s();
  const auto position = [&path](double slot, bool u) {
    const auto field = path.at(Direction::forward, slot);
    return u ? field.u_mm : field.v_mm;
  };
  for (const bool u : {true, false}) {
    double before = 0;
    for (double slot = 0; slot < 2.1 * static_cast<double>(path.timing().slots); slot += kStep) {
      const double a = (position(slot + kStep, u) - 2 * position(slot, u) + position(slot - kStep, u)) / (h * h);
      ASSERT_LE(std::abs(a), a_max * 1.002) << (u ? "U" : "V") << " at slot " << slot;
      if (slot > 0) {
        ASSERT_LE(std::abs(a - before) / h, j_max * 1.1 + 1e12) << (u ? "U" : "V") << " at slot " << slot;
      }
      before = a;
    }
  }
}

TEST(LinePath, TurnsWithinTheLimitsOfTheScanner) {
  expect_within_limits(LinePath::plan(roller_timing(), roller_geometry(), true).value(), 4e7, 4e12);
  const LineTiming tight = with_turn(1620);
  expect_within_limits(LinePath::plan(tight, roller_geometry(tight), true).value(), 4e7, 4e12);
}

TEST(LinePath, FliesBackWithinTheLimitsWhereAllLinesRunForward) {
  LineTiming timing = with_turn(6000);
  timing.bidirectional = false;
  const LinePath path = LinePath::plan(timing, roller_geometry(timing), true).value();
  expect_within_limits(path, 4e7, 4e12);
  const auto slots = static_cast<double>(timing.slots);
  EXPECT_EQ(path.at(Direction::forward, 3000).u_mm, path.at(Direction::forward, 3000 + slots).u_mm);
}

TEST(LinePath, KnowsTheShortestTurn) {
  // From v to -v: 2 v/a + a/j = 800 + 10 us = 1620 slots of 0.5 us.
  const LineTiming exact = with_turn(1620);
  const auto path = LinePath::plan(exact, roller_geometry(exact), true);
  ASSERT_TRUE(path) << path.error().message;
  const MirrorTurn& turn = path.value().turn_after(Direction::forward)[0];
  EXPECT_NEAR(turn.shortest_s, 810e-6, 1e-12);
  EXPECT_NEAR(turn.peak_acceleration_mm_s2, 4e7, 4e7 * 1e-9);

  for (const std::int64_t slots : {1619, 1000, 1}) {
    const LineTiming timing = with_turn(slots);
    const auto refused = LinePath::plan(timing, roller_geometry(timing), true);
    ASSERT_FALSE(refused) << slots;
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
    EXPECT_NE(refused.error().message.find("make turn_slots 1620 or more"), std::string::npos)
        << refused.error().message;
  }
}

TEST(LinePath, NamesATurnThatDoesWhateverTheMicrovectors) {
  for (const std::int64_t step : {1, 7, 20, 64}) {
    for (const std::int64_t offset : {-9, 0, 12}) {
      const auto timing_of = [step, offset](std::int64_t turn_slots) {
        LineTiming timing = roller_timing();
        timing.slots_per_microvector = step;
        timing.slots = (timing.pixels + turn_slots + step - 1) / step * step;
        timing.forward_first_slot = (timing.slots - timing.pixels) / 2;
        timing.offset_slots = offset;
        timing.reverse_first_slot = timing.slots - timing.pixels - timing.forward_first_slot + offset;
        return timing;
      };
      const LineTiming shorter = timing_of(1000);
      const std::string message = LinePath::plan(shorter, roller_geometry(shorter), true).error().message;
      const std::int64_t named = std::stoll(message.substr(message.find("turn_slots ") + 11));
      for (const std::int64_t turn_slots : {named, named - 1}) {
        const LineTiming timing = timing_of(turn_slots);
        EXPECT_EQ(static_cast<bool>(LinePath::plan(timing, roller_geometry(timing), true)), turn_slots == named)
            << step << ", " << offset << ": " << turn_slots;
      }
    }
  }
}

TEST(LinePath, NoTurnAtAllIsRefusedEvenWithoutLimits) {
  const LineTiming timing = with_turn(0);
  kinematics::ScanHead head = roller_head();
  head.max_speed_mm_s = head.max_acceleration_mm_s2 = head.max_jerk_mm_s3 = std::nullopt;
  const auto refused = LinePath::plan(timing, roller_geometry(timing, head), true);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("make turn_slots 2 or more"), std::string::npos) << refused.error().message;
}

TEST(LinePath, LongerTurnsAreGentler) {
  double before = 1e9;
  for (const std::int64_t slots : {1620, 1800, 2200, 3000}) {
    const LineTiming timing = with_turn(slots);
    kinematics::ScanHead head = roller_head();
    head.field_mm = 50;
    const MirrorTurn turn =
        LinePath::plan(timing, roller_geometry(timing, head), true).value().turn_after(Direction::reverse)[0];
    EXPECT_LT(turn.peak_acceleration_mm_s2, before);
    EXPECT_NEAR(turn.profile.access_time_s(), static_cast<double>(slots) * 0.5e-6, 1e-15) << "all the time there is";
    before = turn.peak_acceleration_mm_s2;
  }
}

TEST(LinePath, ChoosesJerkOrAccelerationItselfWhereOneIsNotLimited) {
  const LineTiming timing = with_turn(1610);  // more than 2 v/a = 1600 slots: only a steep jerk keeps the acceleration
  kinematics::ScanHead head = roller_head();
  head.max_jerk_mm_s3 = std::nullopt;
  const auto path = LinePath::plan(timing, roller_geometry(timing, head), true);
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_LE(path.value().turn_after(Direction::forward)[0].peak_acceleration_mm_s2, 4e7);
  head = roller_head();
  head.max_acceleration_mm_s2 = std::nullopt;
  head.max_jerk_mm_s3 = 2e11;
  const auto free = LinePath::plan(timing, roller_geometry(timing, head), true);
  ASSERT_TRUE(free) << free.error().message;
  const MirrorTurn& turn = free.value().turn_after(Direction::forward)[0];
  EXPECT_LE(turn.peak_jerk_mm_s3, 2e11);
  EXPECT_NEAR(turn.shortest_s, 2 * std::sqrt(2 * 16'000 / 2e11), 1e-12) << "800 us, the acceleration runs free";
}

TEST(LinePath, ReverseLinesAreForwardLinesBackwardsInTime) {
  const LineTiming timing = with_turn(1801);  // odd: the windows are not in the middle
  const LinePath path = LinePath::plan(timing, roller_geometry(timing), false).value();
  const auto slots = static_cast<double>(timing.slots);
  for (double slot = 0; slot <= slots; slot += 7.3) {
    EXPECT_NEAR(path.at(Direction::reverse, slot).u_mm, path.at(Direction::forward, slots - 1 - slot).u_mm, 1e-9)
        << slot;
  }
}

TEST(LinePath, HoldsTheSpeedWhereThePulsesOfReverseLinesAreLater) {
  LineTiming timing = with_turn(1800);
  timing.offset_slots = 12;
  timing.reverse_first_slot += 12;
  const LinePath path = LinePath::plan(timing, roller_geometry(timing), true).value();
  const double last = static_cast<double>(timing.slot_of_pixel(Direction::reverse, 0));
  const double pitch = path.at(Direction::reverse, last - 1).u_mm - path.at(Direction::reverse, last).u_mm;
  EXPECT_NEAR(pitch, 0.008, 1e-12);
  EXPECT_NEAR(path.at(Direction::reverse, last).u_mm, -13.996 - 12 * 0.008, 1e-12) << "the path itself is not moved";
}

TEST(LinePath, IsTheSineOfTheAngleOffAxisToo) {
  const LineTiming timing = roller_timing();
  CylinderLines lines = test::tube_lines();
  lines.offset_deg = 20;
  const LinePath path = LinePath::plan(timing, cylinder_geometry(timing, lines, roller_head()).value(), true).value();
  const double radius = 0.9;
  const double offset = test::kPi / 9;
  const double per_slot = 2 * test::kPi / 40 / 5400;
  for (double slot = 950; slot <= 4449; slot += 13.7) {
    const double angle = offset - per_slot * (slot - 2699.5);
    const auto field = path.at(Direction::forward, slot);
    ASSERT_NEAR(field.v_mm, radius * std::sin(angle), 1e-13);
    ASSERT_NEAR(field.w_mm, radius * (std::cos(angle) - std::cos(offset)), 1e-13);
  }
  const auto v = [&path](double slot) { return path.at(Direction::forward, slot).v_mm; };
  const double h = 300 * timing.slot_s();
  const double a = (v(3300) - 2 * v(3000) + v(2700)) / (h * h);
  const double speed = per_slot / timing.slot_s();
  EXPECT_NEAR(a, -radius * speed * speed * std::sin(offset - per_slot * 300.5), std::abs(a) * 1e-4);
}

TEST(LinePath, RefusesWhatTheScannerCannotDo) {
  const auto refusal = [](const kinematics::ScanHead& head) {
    const auto path = LinePath::plan(roller_timing(), roller_geometry(roller_timing(), head), true);
    return path ? std::string() : path.error().message;
  };
  kinematics::ScanHead slow = roller_head();
  slow.max_speed_mm_s = 15'999;
  EXPECT_NE(refusal(slow).find("U moves at 16000 mm/s while a line is marked: faster than max_speed_mm_s = 15999"),
            std::string::npos)
      << refusal(slow);
  kinematics::ScanHead small = roller_head();
  small.field_mm = 27.99;  // the outermost pulses are 27.992 mm apart
  EXPECT_NE(refusal(small).find("field_mm = 27.99"), std::string::npos) << refusal(small);
  small.field_mm = 28;  // enough for the window, not for the turn
  EXPECT_EQ(refusal(small), "");
  EXPECT_EQ(refusal(roller_head()), "");
}

}  // namespace
}  // namespace gravure::scan
