#pragma once

#include "gravure/kinematics/machine.hpp"
#include "gravure/scan/line_timing.hpp"

namespace gravure::scan {

/// What a raster mode says of its lines: which machine, how its joints move while a line passes, and where the line
/// lies. All lines of a job are alike but for whole steps of the joints, so this is told once, for one line. The middle
/// of every forward marking window finds the joints at `at_centre`; reverse lines are aimed at the places evenly
/// between.
struct LineGeometry {
  kinematics::Machine machine;
  kinematics::JointPositions at_centre;  ///< mm and rad
  kinematics::JointPositions per_slot;   ///< how far each joint moves in one pulse slot
  double pixel_pitch_mm = 0;
  double centre_u_mm = 0;  ///< field coordinates of the middle of the window
  double centre_v_mm = 0;
  kinematics::Vector3 surface_normal = kinematics::Vector3::UnitZ();  ///< on the line, in the workpiece's frame
};

/// Lines along the axis of a turning cylinder.
struct CylinderLines {
  double diameter_mm = 0;
  std::int64_t lines_per_revolution = 0;
  double pixel_pitch_mm = 0;
  double offset_deg = 0;            ///< where round the circumference the lines lie; the incidence angle
  double carriage_mm_per_line = 0;  ///< helical: how far the head moves along the axis
};

/// Lines on a flat panel that moves across them.
struct PlaneLines {
  double line_pitch_mm = 0;
  double pixel_pitch_mm = 0;
};

/// The focus is set to the line: the head stands at radius * cos(offset) above the axis, V at radius * sin(offset).
/// Fails with out_of_range where a value makes no cylinder, or the line lies beyond kMostIncidenceDeg.
Result<LineGeometry> cylinder_geometry(const LineTiming& timing, const CylinderLines& lines,
                                       const kinematics::ScanHead& head);
Result<LineGeometry> plane_geometry(const LineTiming& timing, const PlaneLines& lines,
                                    const kinematics::ScanHead& head);

/// The lines of a rotary plan.
CylinderLines cylinder_lines(const Plan& plan, double offset_deg);

/// Light that grazes the surface more than this (from its normal) is refused.
inline constexpr double kMostIncidenceDeg = 85;

}  // namespace gravure::scan
