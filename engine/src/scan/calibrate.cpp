#include "gravure/scan/calibrate.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "gravure/core/csv_rows.hpp"
#include "gravure/core/units.hpp"

namespace gravure::scan {
namespace {

constexpr double kMostLanding_mm = 1e4;

/// Sums up the normal equations row by row: each row is a few weighted nodes.
class Fit {
 public:
  explicit Fit(const FieldGrid& grid)
      : matrix_(Eigen::MatrixXd::Zero(nodes(grid), nodes(grid))), right_(Eigen::MatrixXd::Zero(nodes(grid), 2)) {}

  struct Term {
    std::size_t node = 0;
    double weight = 0;
  };

  void add(std::span<const Term> terms, double factor, const GridPoint& value) {
    for (const Term& a : terms) {
      const auto i = static_cast<Eigen::Index>(a.node);
      for (const Term& b : terms) {
        matrix_(i, static_cast<Eigen::Index>(b.node)) += factor * a.weight * b.weight;
      }
      right_(i, 0) += factor * a.weight * value.u_mm;
      right_(i, 1) += factor * a.weight * value.v_mm;
    }
  }

  void solve() {
    inverse_ = matrix_.ldlt().solve(Eigen::MatrixXd::Identity(matrix_.rows(), matrix_.cols()));
    errors_ = matrix_.ldlt().solve(right_);
  }
  GridPoint error(std::size_t node) const {
    const auto i = static_cast<Eigen::Index>(node);
    return {errors_(i, 0), errors_(i, 1)};
  }
  /// By how much of itself a row with these terms moves its own fitted value: 0 to 1.
  double leverage(std::span<const Term> terms) const {
    double sum = 0;
    for (const Term& a : terms) {
      for (const Term& b : terms) {
        sum += a.weight * b.weight * inverse_(static_cast<Eigen::Index>(a.node), static_cast<Eigen::Index>(b.node));
      }
    }
    return sum;
  }

 private:
  static Eigen::Index nodes(const FieldGrid& grid) { return static_cast<Eigen::Index>(grid.columns * grid.rows); }
  Eigen::MatrixXd matrix_;
  Eigen::MatrixXd right_;
  Eigen::MatrixXd inverse_;
  Eigen::MatrixXd errors_;
};

/// The four nodes round a point, with their shares of the error at it.
std::array<Fit::Term, 4> nodes_round(const FieldGrid& grid, const GridPoint& point) {
  const auto cell = [](double value, double first, double last, std::size_t nodes, double& share) {
    const double cells = (value - first) / (last - first) * static_cast<double>(nodes - 1);
    const auto index = std::min(static_cast<std::size_t>(cells), nodes - 2);
    share = cells - static_cast<double>(index);
    return index;
  };
  double u = 0;
  double v = 0;
  const std::size_t column = cell(point.u_mm, grid.u_first_mm, grid.u_last_mm, grid.columns, u);
  const std::size_t row = cell(point.v_mm, grid.v_first_mm, grid.v_last_mm, grid.rows, v);
  const std::size_t node = row * grid.columns + column;
  return {{{node, (1 - u) * (1 - v)},
           {node + 1, u * (1 - v)},
           {node + grid.columns, (1 - u) * v},
           {node + grid.columns + 1, u * v}}};
}

GridPoint error_of(const MeasuredPoint& point) {
  return {point.landing.u_mm - point.order.u_mm, point.landing.v_mm - point.order.v_mm};
}

/// Second differences along U and V, and the mixed ones: a bent grid costs, a plane one does not.
void add_bending(Fit& fit, const FieldGrid& grid, double factor) {
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const std::size_t node = row * grid.columns + column;
      if (column + 2 < grid.columns) {
        fit.add(std::array<Fit::Term, 3>{{{node, 1}, {node + 1, -2}, {node + 2, 1}}}, factor, {});
      }
      if (row + 2 < grid.rows) {
        fit.add(std::array<Fit::Term, 3>{{{node, 1}, {node + grid.columns, -2}, {node + 2 * grid.columns, 1}}}, factor,
                {});
      }
      if (column + 1 < grid.columns && row + 1 < grid.rows) {
        fit.add(
            std::array<Fit::Term, 4>{
                {{node, 1}, {node + 1, -1}, {node + grid.columns, -1}, {node + grid.columns + 1, 1}}},
            factor, {});
      }
    }
  }
}

/// Spread of the points in the direction in which they are spread least, against the field.
double least_spread(const std::vector<MeasuredPoint>& points, double field_mm) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const MeasuredPoint& point : points) {
    middle += Eigen::Vector2d(point.order.u_mm, point.order.v_mm) / static_cast<double>(points.size());
  }
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const MeasuredPoint& point : points) {
    const Eigen::Vector2d offset = Eigen::Vector2d(point.order.u_mm, point.order.v_mm) - middle;
    spread += offset * offset.transpose();
  }
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvalues()[0];
  return std::sqrt(std::max(0.0, least)) / field_mm;
}

Result<void> check_request(const std::vector<MeasuredPoint>& points, const CalibrationRequest& request) {
  if (!(request.field_mm > 0 && request.field_mm <= 1e4)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("calibrate: field_mm = {}: must be above 0 and at most 10000", request.field_mm)};
  }
  for (const std::size_t nodes : {request.columns, request.rows}) {
    if (nodes < 2 || nodes > kMostCalibrationNodes) {
      return Error{ErrorCode::out_of_range,
                   fmt::format("calibrate: {} nodes: must be 2 to {} a side", nodes, kMostCalibrationNodes)};
    }
  }
  if (!(request.smoothing >= kLeastSmoothing && request.smoothing <= 1)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("calibrate: smoothing = {}: must be {} to 1", request.smoothing, kLeastSmoothing)};
  }
  const double half = request.field_mm / 2;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const MeasuredPoint& point = points[i];
    if (!(std::abs(point.order.u_mm) <= half && std::abs(point.order.v_mm) <= half)) {
      return Error{ErrorCode::out_of_range,
                   fmt::format("calibrate: mark {}: order U = {}, V = {} mm: must lie in the field of {} mm", i,
                               point.order.u_mm, point.order.v_mm, request.field_mm)};
    }
    if (!(std::hypot(point.landing.u_mm, point.landing.v_mm) <= kMostLanding_mm)) {
      return Error{ErrorCode::out_of_range,
                   fmt::format("calibrate: mark {}: landing U = {}, V = {} mm: must be within {} mm of the centre", i,
                               point.landing.u_mm, point.landing.v_mm, kMostLanding_mm)};
    }
  }
  if (points.size() < 3 || least_spread(points, request.field_mm) < 1e-6) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("calibrate: {} marks: at least three are needed, not on one line", points.size())};
  }
  return {};
}

/// Fills in the largest misfit and the point that stands out; the sum of the misfits' squares in um^2.
double see_misfits(const std::vector<MeasuredPoint>& points, const Fit& fit, Calibration& calibration) {
  constexpr double kRounding_um = 1e-6;
  constexpr double kLeastFreedom = 1e-6;  // of a point that is all its nodes know: its distance is rounding
  double squares = 0;
  double most_saved = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::array<Fit::Term, 4> nodes = nodes_round(calibration.grid, points[i].order);
    GridPoint left = error_of(points[i]);
    for (const Fit::Term& term : nodes) {
      const GridPoint at_node = fit.error(term.node);
      left.u_mm -= term.weight * at_node.u_mm;
      left.v_mm -= term.weight * at_node.v_mm;
    }
    const double misfit_um = std::hypot(left.u_mm, left.v_mm) * kUmPerMm;
    squares += misfit_um * misfit_um;
    calibration.max_um = std::max(calibration.max_um, misfit_um);
    // Left out, a point of leverage h lies 1 / (1 - h) times as far off, and the fit costs misfit^2 / (1 - h) less.
    const double freedom = std::max(1 - fit.leverage(nodes), kLeastFreedom);
    const double saved = misfit_um * misfit_um / freedom;
    if (saved > most_saved && misfit_um > kRounding_um) {
      most_saved = saved;
      calibration.worst_alone_um = misfit_um / freedom;
      calibration.worst = i;
    }
  }
  return squares;
}

}  // namespace

Result<std::vector<MeasuredPoint>> parse_measured_points(std::string_view text) {
  std::vector<MeasuredPoint> points;
  GRAVURE_CHECK(
      read_csv_rows(text,
                    {"measured points", "u_order, v_order, u_landing and v_landing in mm, four numbers and no more", 4,
                     "u_order_mm,v_order_mm,u_landing_mm,v_landing_mm"},
                    [&points](std::span<const double> row) {
                      points.push_back({{row[0], row[1]}, {row[2], row[3]}});
                    }));
  return points;
}

Result<Calibration> calibrate_field(const std::vector<MeasuredPoint>& points, const CalibrationRequest& request) {
  GRAVURE_CHECK(check_request(points, request));
  const double half = request.field_mm / 2;
  Calibration calibration;
  FieldGrid& grid = calibration.grid;
  grid = {request.columns, request.rows, -half, half, -half, half, {}};
  Fit fit(grid);
  for (const MeasuredPoint& point : points) {
    fit.add(nodes_round(grid, point.order), 1, error_of(point));
  }
  add_bending(fit, grid, request.smoothing);
  fit.solve();
  for (std::size_t node = 0; node < request.columns * request.rows; ++node) {
    grid.errors.push_back(fit.error(node));
  }
  const double squares = see_misfits(points, fit, calibration);
  const Result<void> sound = check_field_grid(grid);
  if (!sound) {
    const GridPoint& at = points[calibration.worst].order;
    return Error{
        sound.error().code,
        fmt::format("calibrate: mark {} at U {} mm, V {} mm lies {:.4g} um from where the other marks say: look "
                    "at it first. As they stand they make no field grid ({})",
                    calibration.worst, at.u_mm, at.v_mm, calibration.worst_alone_um, sound.error().message)};
  }
  calibration.rms_um = std::sqrt(squares / static_cast<double>(points.size()));
  return calibration;
}

}  // namespace gravure::scan
