#include "gravure/scan/field_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gravure/core/units.hpp"

namespace gravure::scan {
namespace {

constexpr double kMostSlope = 0.5;  ///< of the error along the grid: keeps the inverse unique and its search converging
constexpr double kConverged = 1e-13;  ///< mm
constexpr double kEdgeSlack = 1e-9;   ///< mm beyond the last node that rounding may put a point on the edge
constexpr int kMostSteps = 200;

double step(double first, double last, std::size_t nodes) noexcept {
  return (last - first) / static_cast<double>(nodes - 1);
}

/// Cell and share of it for one coordinate already known to be inside.
struct Cell {
  std::size_t index;
  double share;
};

Cell cell_of(double value, double first, double last, std::size_t nodes) noexcept {
  const double cells = std::clamp((value - first) / step(first, last, nodes), 0.0, static_cast<double>(nodes - 1));
  const auto index = std::min(static_cast<std::size_t>(cells), nodes - 2);
  return {index, cells - static_cast<double>(index)};
}

GridPoint error_at(const FieldGrid& grid, const GridPoint& order) noexcept {
  const Cell u = cell_of(order.u_mm, grid.u_first_mm, grid.u_last_mm, grid.columns);
  const Cell v = cell_of(order.v_mm, grid.v_first_mm, grid.v_last_mm, grid.rows);
  const GridPoint* const below = &grid.errors[v.index * grid.columns + u.index];
  const GridPoint* const above = below + grid.columns;
  const auto mix = [&u, &v](double a, double b, double c, double d) {
    return (1 - v.share) * ((1 - u.share) * a + u.share * b) + v.share * ((1 - u.share) * c + u.share * d);
  };
  return {mix(below[0].u_mm, below[1].u_mm, above[0].u_mm, above[1].u_mm),
          mix(below[0].v_mm, below[1].v_mm, above[0].v_mm, above[1].v_mm)};
}

bool is_inside(const FieldGrid& grid, const GridPoint& point) noexcept {
  return point.u_mm >= grid.u_first_mm - kEdgeSlack && point.u_mm <= grid.u_last_mm + kEdgeSlack &&
         point.v_mm >= grid.v_first_mm - kEdgeSlack && point.v_mm <= grid.v_last_mm + kEdgeSlack;
}

Error outside(const FieldGrid& grid, const GridPoint& point, const char* what) {
  return {
      ErrorCode::out_of_range,
      fmt::format("field grid: {} U = {}, V = {} mm lies outside the grid ({} to {}, {} to {} mm); measure a larger "
                  "grid or use less of the field",
                  what, point.u_mm, point.v_mm, grid.u_first_mm, grid.u_last_mm, grid.v_first_mm, grid.v_last_mm)};
}

double length(const GridPoint& a) noexcept {
  return std::hypot(a.u_mm, a.v_mm);
}

GridPoint minus(const GridPoint& a, const GridPoint& b) noexcept {
  return {a.u_mm - b.u_mm, a.v_mm - b.v_mm};
}

/// Largest second difference of the errors along one direction (`stride` between neighbours).
double bending(const FieldGrid& grid, std::size_t stride, std::size_t columns, std::size_t rows) noexcept {
  double most = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const GridPoint* const at = &grid.errors[row * grid.columns + column];
      const GridPoint before = minus(at[stride], at[0]);
      const GridPoint after = minus(at[2 * stride], at[stride]);
      most = std::max(most, length(minus(after, before)));
    }
  }
  return most;
}

}  // namespace

GridPoint FieldGrid::node(std::size_t column, std::size_t row) const noexcept {
  const double u_share = static_cast<double>(column) / static_cast<double>(columns - 1);
  const double v_share = static_cast<double>(row) / static_cast<double>(rows - 1);
  return {u_first_mm + u_share * (u_last_mm - u_first_mm), v_first_mm + v_share * (v_last_mm - v_first_mm)};
}

Result<GridPoint> FieldGrid::lands_at(const GridPoint& order) const {
  if (!is_inside(*this, order)) {
    return outside(*this, order, "order");
  }
  const GridPoint error = error_at(*this, order);
  return GridPoint{order.u_mm + error.u_mm, order.v_mm + error.v_mm};
}

/// order = place - error(order): converges because the error changes by less than the order does. On the way the order
/// is held inside the grid.
Result<GridPoint> FieldGrid::command_for(const GridPoint& place) const {
  if (!std::isfinite(place.u_mm) || !std::isfinite(place.v_mm)) {
    return outside(*this, place, "place");
  }
  GridPoint order = place;
  for (int k = 0; k < kMostSteps; ++k) {
    const GridPoint next = minus(place, error_at(*this, order));
    const double change = length(minus(next, order));
    order = next;
    if (change <= kConverged) {
      break;
    }
  }
  if (!is_inside(*this, order)) {
    return outside(*this, order, "the order for a place needs");
  }
  return order;
}

double FieldGrid::interpolation_error_um() const noexcept {
  const double along_u = columns > 2 ? bending(*this, 1, columns - 2, rows) : 0;
  const double along_v = rows > 2 ? bending(*this, columns, columns, rows - 2) : 0;
  return (along_u + along_v) / 8 * kUmPerMm;
}

Result<void> check_field_grid(const FieldGrid& grid) {
  const auto refuse = [](const std::string& text) { return Error{ErrorCode::out_of_range, "field grid: " + text}; };
  if (grid.columns < 2 || grid.columns > kMostGridNodes || grid.rows < 2 || grid.rows > kMostGridNodes) {
    return refuse(fmt::format("{} x {} nodes: must be 2 to {} a side", grid.columns, grid.rows, kMostGridNodes));
  }
  if (grid.errors.size() != grid.columns * grid.rows) {
    return refuse(fmt::format("{} errors for {} x {} nodes", grid.errors.size(), grid.columns, grid.rows));
  }
  constexpr double kMost = 1e4;
  const bool is_ordered = grid.u_first_mm < grid.u_last_mm && grid.v_first_mm < grid.v_last_mm &&
                          grid.u_first_mm >= -kMost && grid.u_last_mm <= kMost && grid.v_first_mm >= -kMost &&
                          grid.v_last_mm <= kMost;
  const double u_step = step(grid.u_first_mm, grid.u_last_mm, grid.columns);
  const double v_step = step(grid.v_first_mm, grid.v_last_mm, grid.rows);
  if (!is_ordered || !(u_step >= 1e-6) || !(v_step >= 1e-6)) {
    return refuse(
        fmt::format("U from {} to {} mm, V from {} to {} mm: the first must be below the last, within -{} to {}, "
                    "and nodes at least 1 nm apart",
                    grid.u_first_mm, grid.u_last_mm, grid.v_first_mm, grid.v_last_mm, kMost, kMost));
  }
  for (std::size_t i = 0; i < grid.errors.size(); ++i) {
    const std::size_t column = i % grid.columns;
    const std::size_t row = i / grid.columns;
    const GridPoint& here = grid.errors[i];
    // Half of the allowed slope each way, so that both together stay below it.
    const bool is_steep = (column > 0 && !(length(minus(here, grid.errors[i - 1])) < kMostSlope / 2 * u_step)) ||
                          (row > 0 && !(length(minus(here, grid.errors[i - grid.columns])) < kMostSlope / 2 * v_step));
    if (is_steep || !(length(here) <= kMost)) {
      return refuse(
          fmt::format("column {}, row {}: error {}, {} mm: must be finite and differ from its neighbours' by less "
                      "than a quarter of the way to them",
                      column, row, here.u_mm, here.v_mm));
    }
  }
  return {};
}

}  // namespace gravure::scan
