#pragma once

#include <cmath>

#include "gravure/kinematics/machines.hpp"
#include "gravure/scan/landing.hpp"
#include "gravure/scan/line_trajectory.hpp"

namespace gravure::scan::test {

inline constexpr double kPi = 3.14159265358979323846;

/// The large roller of [B]: 82 MHz seed, every 41st pulse, two FPGA clocks a seed pulse, 8 um pixels and lines, 70 mm
/// diameter, 28 mm wide; the scanner's limits are ours.
inline LineTiming roller_timing() {
  return {164'000'000, 82, 5400, 20, 3500, 950, 950, 0, true};
}

inline kinematics::ScanHead roller_head() {
  kinematics::ScanHead head;
  head.field_mm = 40;
  head.resolution_bits = 20;
  head.max_speed_mm_s = 40'000;
  head.max_acceleration_mm_s2 = 4e7;
  head.max_jerk_mm_s3 = 4e12;
  return head;
}

inline CylinderLines roller_lines() {
  return {70, 27'489, 0.008, 0, 0};
}

inline LineGeometry roller_geometry(const LineTiming& timing = roller_timing(),
                                    const kinematics::ScanHead& head = roller_head()) {
  return cylinder_geometry(timing, roller_lines(), head).value();
}

/// On a tube so thin, with so few lines, that a line's worth of turning is a real arc.
inline CylinderLines tube_lines() {
  return {1.8, 40, 0.006, 0, 0};
}

inline double surface_speed_mm_s(const LineTiming& timing, const CylinderLines& lines) {
  return kPi * lines.diameter_mm / static_cast<double>(lines.lines_per_revolution) /
         (static_cast<double>(timing.slots) * timing.slot_s());
}

}  // namespace gravure::scan::test
