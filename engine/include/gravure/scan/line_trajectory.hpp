#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/exact.hpp"
#include "gravure/scan/field_grid.hpp"
#include "gravure/scan/line_path.hpp"

namespace gravure::scan {

/// One order to the scanner. Counts are signed, 0 is the centre of the field.
struct SetPoint {
  double u_mm = 0;  ///< wanted, before field correction and rounding
  double v_mm = 0;
  std::int32_t u_count = 0;
  std::int32_t v_count = 0;
};

struct TrajectoryOptions {
  bool cross_scan_correction = true;    ///< V follows the moving surface; without it V stands still
  bool lag_compensation = true;         ///< set-points are early by the scanner's lag
  std::optional<FieldGrid> field_grid;  ///< the scanner's distortion, undone in the set-points
};

/// How well a line can be followed; the largest over all pulses of both directions.
struct LineQuality {
  double along_um = 0;   ///< error on the surface along the line, everything included
  double across_um = 0;  ///< and across it
  double interpolation_um =
      0;                     ///< error in any direction with set-points that are not rounded: the chords between them
  double defocus_um = 0;     ///< distance from focus on the arc, largest magnitude
  double straight_um = 0;    ///< what a V that moves at constant speed ([B]) would leave: arc against chord
  double incidence_deg = 0;  ///< largest angle between the beam and the surface's normal while marking
};

/// What the galvo is told line after line. Made only by make_line_trajectory(), which guarantees that every pulse lies
/// in the field, that turns keep the scanner's limits, and that lines of one direction are alike to the bit. In the
/// turns set-points may leave the field, with a warning.
struct LineTrajectory {
  LinePath path;
  TrajectoryOptions options;
  double resolution_mm = 0;  ///< one count
  double scan_speed_mm_s = 0;
  std::int64_t lag_ticks = 0;        ///< set-points are early by so many ticks
  Rational lag_remainder_ticks = 0;  ///< lag - lag_ticks: what whole ticks leave uncompensated, at most half a tick
  std::vector<SetPoint> forward;     ///< one for each microvector, at its start
  std::vector<SetPoint> reverse;     ///< empty where all lines run forward
  LineQuality quality;
  double field_grid_error_um = 0;  ///< of the grid's interpolation, estimated
  std::vector<std::string> warnings;

  const std::vector<SetPoint>& set_points(Direction direction) const noexcept {
    return direction == Direction::forward ? forward : reverse;
  }
};

/// Lines of more pulses, or of more set-points, are refused: so many fit into the memory that commands may take.
inline constexpr std::int64_t kMostPulsesPerLine = std::int64_t{1} << 19;

/// Fails as check_timing(), check_machine() and LinePath::plan() do, and with out_of_range where the lag is longer than
/// a line, a line has more pulses or set-points than kMostPulsesPerLine, or a pulse that the field grid shifts would be
/// ordered outside the field.
Result<LineTrajectory> make_line_trajectory(const LineTiming& timing, const LineGeometry& geometry,
                                            const TrajectoryOptions& options);

}  // namespace gravure::scan
