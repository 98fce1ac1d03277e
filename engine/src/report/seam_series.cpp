#include <algorithm>
#include <numeric>

#include "gravure/report/report_data.hpp"

namespace gravure::report {

SeamSeries seam_series(const VerifyReport& verified, const Plan& plan, std::size_t most_points) {
  SeamSeries series;
  series.limit_um = verified.seam_limit_um;
  const Rational steps = Rational(2 * Integer(plan.ab.increment));
  if (plan.ab.increment > 0) {
    series.bound_um_per_revolution = to_double(Rational(plan.rotary.circumference_um / steps));
  }
  const std::size_t rows = verified.seam.size();
  const std::size_t points = std::min(rows, std::max<std::size_t>(2, most_points));
  for (std::size_t i = 0; i < points; ++i) {
    const SeamRow& row = verified.seam[points == 1 ? 0 : i * (rows - 1) / (points - 1)];
    series.points.push_back({row.revolution, row.drift_um});
  }
  return series;
}

CellRelief::CellRelief(const LayerPictures& pictures, const Plan& plan, const std::optional<PulseRemoval>& removal)
    : pictures_(pictures),
      widths_(cell_sizes(pictures.cells.width, pictures.picture.width)),
      heights_(cell_sizes(pictures.cells.height, pictures.picture.height)) {
  const Extent& cells = pictures.cells;
  const Incidence incidence(plan);
  const double pixel_um = to_double(plan.line.pixel_pitch_um);
  const double line_um = to_double(plan.rotary.line_pitch_um);
  const std::int64_t along = pictures.lines_are_rows ? cells.width : cells.height;
  per_pulse_.assign(static_cast<std::size_t>(along), 1.0);
  for (std::int64_t column = 0; removal && column < along; ++column) {
    const std::int64_t columns = image_columns(plan);
    const std::int64_t middle = (cell_begin(column, along, columns) + cell_begin(column + 1, along, columns) - 1) / 2;
    per_pulse_[static_cast<std::size_t>(column)] =
        removal->volume_um3(incidence.at_column_rad(middle)) / (pixel_um * line_um);
  }
}

double CellRelief::removed(std::int64_t column, std::int64_t row) const {
  const auto cell = static_cast<std::size_t>(row * pictures_.cells.width + column);
  const std::int64_t along = pictures_.lines_are_rows ? column : row;
  return static_cast<double>(pictures_.pulses[cell]) * per_pulse_[static_cast<std::size_t>(along)];
}

double CellRelief::at(std::int64_t column, std::int64_t row) const {
  const std::int64_t pixels = widths_[static_cast<std::size_t>(column)] * heights_[static_cast<std::size_t>(row)];
  return removed(column, row) / static_cast<double>(pixels);
}

Relief relief_of(const LayerPictures& pictures, const Plan& plan, const std::optional<PulseRemoval>& removal,
                 ReliefCells cells) {
  Relief relief;
  relief.in_um = removal.has_value();
  const Incidence incidence(plan);
  const double pixel_um = to_double(plan.line.pixel_pitch_um);
  const double line_um = to_double(plan.rotary.line_pitch_um);
  const CellRelief of_cell(pictures, plan, removal);
  double removed = 0;
  if (cells == ReliefCells::kept) {
    relief.cells.reserve(static_cast<std::size_t>(pictures.cells.area()));
  }
  for (std::int64_t row = 0; row < pictures.cells.height; ++row) {
    for (std::int64_t column = 0; column < pictures.cells.width; ++column) {
      const double depth = of_cell.at(column, row);
      relief.deepest = std::max(relief.deepest, depth);
      removed += of_cell.removed(column, row);
      if (cells == ReliefCells::kept) {
        relief.cells.push_back(depth);
      }
    }
  }
  relief.mean = removed / static_cast<double>(pictures.picture.area());
  relief.seam.assign(pictures.seam_pulses.begin(), pictures.seam_pulses.end());
  if (removal) {
    const SeamPlace& place = pictures.seam_place;
    const Extent extent = pictures.seam_extent();
    const bool rows = pictures.lines_are_rows;
    const PulseWindow window{extent.width, extent.height,       rows ? pixel_um : line_um, rows ? line_um : pixel_um,
                             rows,         pictures.seam_pulses};
    relief.seam = window_depth_um(window, *removal, incidence.at_column_rad(place.first_column + place.columns / 2));
  }
  for (const double depth : relief.seam) {
    relief.seam_deepest = std::max(relief.seam_deepest, depth);
  }
  return relief;
}

}  // namespace gravure::report
