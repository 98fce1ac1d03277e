#include "gravure/report/pulse_removal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "report_support.hpp"

namespace gravure::report {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(PulseRemoval, HasTheRadiiOfTheTestVectors) {
  // [D], I0 / Ith = 2: radius against that at normal incidence, across and along the tilt.
  const PulseRemoval removal{20.4256, 2, 1, 0.1};
  const double upright = removal.radius_um(0);
  EXPECT_NEAR(upright, 20.4256 * std::sqrt(std::log(2.0) / 2), 1e-12);
  for (const auto& [degrees, across, along] :
       {std::tuple{5.0, 0.997246, 1.001055}, {10.0, 0.988895, 1.004151}, {45.0, 0.707107, 1.000000}}) {
    const double angle = degrees * kDegree;
    EXPECT_NEAR(removal.radius_um(angle) / upright, across, 1e-6);
    EXPECT_NEAR(removal.radius_um(angle) / std::cos(angle) / upright, along, 1e-6);
  }
  EXPECT_EQ(removal.radius_um(61 * kDegree), 0);
  EXPECT_EQ(removal.volume_um3(61 * kDegree), 0);
}

TEST(PulseRemoval, HasTheVolumeOfItsDepths) {
  for (const double degrees : {0.0, 20.0, 40.0}) {
    const double angle = degrees * kDegree;
    const PulseRemoval removal{12, 3, 1, 0.05};
    const double step = 0.1;
    double volume = 0;
    for (double x = -20; x <= 20; x += step) {
      for (double y = -20; y <= 20; y += step) {
        volume += removal.depth_at_um(x, y, angle) * step * step;
      }
    }
    EXPECT_NEAR(volume / removal.volume_um3(angle), 1, 1e-3) << degrees;
    EXPECT_EQ(removal.depth_at_um(0, 0, angle), removal.depth_um(angle));
  }
}

TEST(PulseRemoval, NeedsAllFourKeysAndNamesTheOthers) {
  LaserSettings laser;
  EXPECT_EQ(absent_removal_keys(laser), "spot_um, fluence_j_cm2, threshold_j_cm2, penetration_nm");
  laser.spot_um = 25;
  laser.fluence_j_cm2 = 2;
  laser.penetration_nm = 40;
  EXPECT_FALSE(pulse_removal(laser));
  EXPECT_EQ(absent_removal_keys(laser), "threshold_j_cm2");
  laser.threshold_j_cm2 = 1;
  ASSERT_TRUE(pulse_removal(laser));
  EXPECT_EQ(pulse_removal(laser)->waist_um, 12.5);
  EXPECT_NEAR(pulse_removal(laser)->penetration_um, 0.04, 1e-15);
}

TEST(WindowDepth, AddsTheCratersOfItsPulses) {
  const PulseRemoval removal{10, 4, 1, 0.1};
  PulseWindow window{21, 17, 2, 3, true, std::vector<std::int64_t>(21 * 17)};
  window.pulses[5 * 21 + 7] = 2;
  window.pulses[9 * 21 + 20] = 1;
  for (const bool down : {true, false}) {
    window.tilt_down = down;
    const std::vector<double> depth = window_depth_um(window, removal, 0.5);
    for (std::int64_t y = 0; y < 17; ++y) {
      for (std::int64_t x = 0; x < 21; ++x) {
        const auto of = [&](std::int64_t at_x, std::int64_t at_y) {
          const double right = 2.0 * static_cast<double>(x - at_x);
          const double below = 3.0 * static_cast<double>(y - at_y);
          return down ? removal.depth_at_um(right, below, 0.5) : removal.depth_at_um(below, right, 0.5);
        };
        ASSERT_NEAR(depth[static_cast<std::size_t>(y * 21 + x)], 2 * of(7, 5) + of(20, 9), 1e-12) << x << ", " << y;
      }
    }
  }
}

TEST(Incidence, IsTheOffsetOfTheLineAndNoneWithoutAScanner) {
  test::SmallJob small;
  test::prepare(small, LinesAlong::rows, Fires::white, 1);
  Plan plan = small.program.header.plan;
  EXPECT_EQ(Incidence(plan).at_column_rad(3), 0);
  plan.scanner = ScannerPlan{};
  plan.scanner->field_mm = 20;
  plan.scanner->offset_deg = 30;
  EXPECT_NEAR(Incidence(plan).at_column_rad(3), 30 * kDegree, 1e-12);
  plan.scanner->offset_deg = 0;
  plan.scanner->tilt_deg_per_mm = 2;
  // 45 pixels of 8 um: the first one is 0.176 mm from the middle.
  EXPECT_NEAR(Incidence(plan).at_column_rad(0), 2 * 0.176 * kDegree, 1e-9);
  EXPECT_NEAR(Incidence(plan).at_column_rad(22), 0, 1e-7);
}

}  // namespace
}  // namespace gravure::report
