#pragma once

#include <array>

#include "gravure/kinematics/machine.hpp"
#include "gravure/motion/profile.hpp"
#include "gravure/scan/line_geometry.hpp"
#include "gravure/scan/line_timing.hpp"

namespace gravure::scan {

/// How one mirror goes from the end of one marking window to the start of the next.
struct MirrorTurn {
  double start_mm = 0;
  double start_mm_s = 0;
  double end_mm_s = 0;
  motion::Profile profile;
  double shortest_s = 0;  ///< under the scanner's limits; 0 where they do not bound it
  double lasts_s = 0;
  double peak_speed_mm_s = 0;
  double peak_acceleration_mm_s2 = 0;
  double peak_jerk_mm_s3 = 0;
  double least_mm = 0;  ///< reach of the mirror's coordinate during the turn
  double most_mm = 0;
};

/// The wanted path of the beam through the field, as a function of time; it repeats every two lines (every line where
/// all run forward). While a line is marked, the spot stays on its target, a row of points on the moving surface; in
/// between both mirrors make jerk-limited turns that use the whole time there is, with as little acceleration as it
/// allows. Constant speed reaches from the set-point before the first pulse to the one after the last.
class LinePath {
 public:
  /// From where to where a line has constant speed, in slots of the line.
  struct Window {
    double begin;
    double end;
  };

  /// Fails with out_of_range where the dark slots are too few for the turn under the scanner's limits, naming the turn
  /// that would do, where a limit is exceeded while marking, and where a pulse lies outside the field. Turns may swing
  /// further than the field: see reach_mm().
  /// `lead_ticks`: how much earlier than the path the set-points are sent.
  static Result<LinePath> plan(const LineTiming& timing, const LineGeometry& geometry, bool cross_scan_correction,
                               std::int64_t lead_ticks = 0);

  /// Where the beam should be `slot` pulse slots after a line of this direction began; any number, also of
  /// neighbouring lines.
  kinematics::FieldPoint at(Direction direction, double slot) const;
  /// The same ignoring turns: as if the line went on for ever.
  kinematics::FieldPoint on_line(Direction direction, double slot) const;

  /// The point of the workpiece a pixel (also between pixels) is meant for.
  kinematics::Vector3 target(double pixel) const;
  /// Joints at a time of a line.
  kinematics::JointPositions joints_at(double slot) const;
  /// How far either mirror gets from the centre of the field, turns included.
  double reach_mm() const noexcept;
  /// The set-points around the first and the last pulse included; outside it the mirrors turn.
  Window marking(Direction direction) const noexcept;
  /// Middle of the forward marking window, the time the joints stand at LineGeometry::at_centre.
  double centre_slot() const noexcept;

  const LineTiming& timing() const noexcept { return timing_; }
  const LineGeometry& geometry() const noexcept { return geometry_; }
  bool cross_scan_correction() const noexcept { return cross_scan_correction_; }
  /// The turn that follows a line of this direction, of U [0] and V [1].
  const std::array<MirrorTurn, 2>& turn_after(Direction direction) const noexcept {
    return turns_[direction == Direction::forward ? 0 : 1];
  }

 private:
  LinePath(const LineTiming& timing, const LineGeometry& geometry, bool cross_scan_correction, std::int64_t lead_ticks)
      : timing_(timing),
        geometry_(geometry),
        cross_scan_correction_(cross_scan_correction),
        lead_slots_(static_cast<double>(lead_ticks) / static_cast<double>(timing.ticks_per_slot)) {}
  Direction other(Direction direction) const noexcept;
  double turn_slots(Direction before) const noexcept;
  std::int64_t enough_turn_slots() const;
  kinematics::FieldPoint in_turn(Direction before, double slot_after_window) const;
  Result<void> plan_turn(Direction before);
  bool is_long_enough(Direction before) const noexcept;
  Result<void> check_turn(Direction before) const;

  LineTiming timing_;
  LineGeometry geometry_;
  bool cross_scan_correction_ = true;
  double lead_slots_ = 0;
  std::array<std::array<MirrorTurn, 2>, 2> turns_;
};

}  // namespace gravure::scan
