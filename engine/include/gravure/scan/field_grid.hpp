#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::scan {

/// A place in the field.
struct GridPoint {
  double u_mm = 0;
  double v_mm = 0;
};

/// What a scanner does wrong, measured at the nodes of a grid: ordered to a node it lands so far beside it. Between
/// nodes the error is interpolated bilinearly. Made by parse_field_grid() and calibrate_field(), which guarantee 2 to
/// kMostGridNodes nodes a side, first < last, and finite errors that change by less than a quarter of the way between
/// neighbouring nodes (so that there is exactly one order for every landing).
struct FieldGrid {
  std::size_t columns = 0;  ///< nodes along U
  std::size_t rows = 0;     ///< nodes along V
  double u_first_mm = 0;
  double u_last_mm = 0;
  double v_first_mm = 0;
  double v_last_mm = 0;
  std::vector<GridPoint> errors;  ///< landing minus order, row by row, U fastest

  /// The node's own place.
  GridPoint node(std::size_t column, std::size_t row) const noexcept;
  /// Where an order lands. Fails with out_of_range outside the grid: nothing is extrapolated.
  Result<GridPoint> lands_at(const GridPoint& order) const;
  /// The order that lands at `place`: the inverse of lands_at(), to 1e-12 mm.
  Result<GridPoint> command_for(const GridPoint& place) const;
  /// How wrong the interpolation between nodes may be, estimated: an eighth of the largest second difference of each
  /// direction, added (the bound of bilinear interpolation, were the nodes' differences the derivatives everywhere). 0
  /// for grids of 2 x 2, which tell nothing of it.
  double interpolation_error_um() const noexcept;
};

inline constexpr std::size_t kMostGridNodes = 1025;
inline constexpr std::size_t kMostGridBytes = std::size_t{1} << 27U;

/// Fails with out_of_range, naming the node, where the guarantees of FieldGrid do not hold.
Result<void> check_field_grid(const FieldGrid& grid);

/// Reads the text form (docs/formats/field_grid.md). Fails with bad_file or out_of_range; messages begin with
/// "path:line: ".
Result<FieldGrid> parse_field_grid(std::string_view text, const std::string& path);

/// The text form; parse_field_grid() gives the same numbers back to the bit.
std::string field_grid_text(const FieldGrid& grid);

}  // namespace gravure::scan
