#pragma once

#include <string_view>
#include <vector>

#include "gravure/scan/field_grid.hpp"

namespace gravure::scan {

/// One mark of a calibration plate.
struct MeasuredPoint {
  GridPoint order;    ///< where the scanner was sent, no correction in force
  GridPoint landing;  ///< where the mark was found
};

struct CalibrationRequest {
  double field_mm = 0;       ///< the grid covers -field/2 to field/2 in both directions
  std::size_t columns = 17;  ///< 2 to kMostCalibrationNodes
  std::size_t rows = 17;
  double smoothing = 1e-4;  ///< weight of bending against misfit; kLeastSmoothing to 1
};

struct Calibration {
  FieldGrid grid;
  double rms_um = 0;  ///< misfit of the points on the grid, both directions together
  double max_um = 0;
  /// The point without which the others fit best: a mark misread, if any was. It pulls the grid towards itself, so
  /// that its neighbours may seem to fit worse.
  std::size_t worst = 0;
  double worst_alone_um = 0;  ///< its distance from a grid that was fitted without it
};

inline constexpr std::size_t kMostCalibrationNodes = 33;
/// With less, rounding in the normal equations shows in the grid (1e-12: below 0.01 um).
inline constexpr double kLeastSmoothing = 1e-12;

/// Points from CSV text: u_order_mm, v_order_mm, u_landing_mm, v_landing_mm, a mark a line. Errors as
/// read_csv_rows() (core) gives them.
Result<std::vector<MeasuredPoint>> parse_measured_points(std::string_view text);

/// The grid that fits the points best, by least squares on its node errors; nodes that no point tells of follow their
/// neighbours straight on (second differences are penalised with `smoothing`). Fails with bad_argument for fewer than
/// three points or points on one line, and with out_of_range for points outside the field and, naming the point that
/// fits worst, as check_field_grid(). Marks count from 0.
Result<Calibration> calibrate_field(const std::vector<MeasuredPoint>& points, const CalibrationRequest& request);

}  // namespace gravure::scan
