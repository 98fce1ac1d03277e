#include "gravure/scan/calibrate.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "gravure/core/csv_rows.hpp"

namespace gravure::scan {
namespace {

constexpr double kUmPerMm = 1000;

/// Sums up the normal equations row by row: each row is a few weighted nodes.
class Fit {
 public:
  explicit Fit(const FieldGrid& grid)
      : matrix_(Eigen::MatrixXd::Zero(nodes(grid), nodes(grid))), right_(Eigen::MatrixXd::Zero(nodes(grid), 2)) {}

  struct Term {
    std::size_t node;
    double weight;
  };

  void add(std::initializer_list<Term> terms, double factor, const GridPoint& value) {
    for (const Term& a : terms) {
      const auto i = static_cast<Eigen::Index>(a.node);
      for (const Term& b : terms) {
        matrix_(i, static_cast<Eigen::Index>(b.node)) += factor * a.weight * b.weight;
      }
      right_(i, 0) += factor * a.weight * value.u_mm;
      right_(i, 1) += factor * a.weight * value.v_mm;
    }
  }

  Eigen::MatrixXd solve() const { return matrix_.ldlt().solve(right_); }

 private:
  static Eigen::Index nodes(const FieldGrid& grid) { return static_cast<Eigen::Index>(grid.columns * grid.rows); }
  Eigen::MatrixXd matrix_;
  Eigen::MatrixXd right_;
};

void add_point(Fit& fit, const FieldGrid& grid, const MeasuredPoint& point) {
  const auto cell = [](double value, double first, double last, std::size_t nodes, double& share) {
    const double cells = (value - first) / (last - first) * static_cast<double>(nodes - 1);
    const auto index = std::min(static_cast<std::size_t>(cells), nodes - 2);
    share = cells - static_cast<double>(index);
    return index;
  };
  double u = 0;
  double v = 0;
  const std::size_t column = cell(point.order.u_mm, grid.u_first_mm, grid.u_last_mm, grid.columns, u);
  const std::size_t row = cell(point.order.v_mm, grid.v_first_mm, grid.v_last_mm, grid.rows, v);
  const std::size_t node = row * grid.columns + column;
  fit.add({{node, (1 - u) * (1 - v)},
           {node + 1, u * (1 - v)},
           {node + grid.columns, (1 - u) * v},
           {node + grid.columns + 1, u * v}},
          1, {point.landing.u_mm - point.order.u_mm, point.landing.v_mm - point.order.v_mm});
}

/// Second differences along U and V, and the mixed ones: a bent grid costs, a plane one does not.
void add_bending(Fit& fit, const FieldGrid& grid, double factor) {
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const std::size_t node = row * grid.columns + column;
      if (column + 2 < grid.columns) {
        fit.add({{node, 1}, {node + 1, -2}, {node + 2, 1}}, factor, {});
      }
      if (row + 2 < grid.rows) {
        fit.add({{node, 1}, {node + grid.columns, -2}, {node + 2 * grid.columns, 1}}, factor, {});
      }
      if (column + 1 < grid.columns && row + 1 < grid.rows) {
        fit.add({{node, 1}, {node + 1, -1}, {node + grid.columns, -1}, {node + grid.columns + 1, 1}}, factor, {});
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
  if (!(request.smoothing > 0 && request.smoothing <= 1)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("calibrate: smoothing = {}: must be above 0 and at most 1", request.smoothing)};
  }
  const double half = request.field_mm / 2;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const MeasuredPoint& point = points[i];
    if (!(std::abs(point.order.u_mm) <= half && std::abs(point.order.v_mm) <= half &&
          std::hypot(point.landing.u_mm, point.landing.v_mm) <= 1e4)) {
      return Error{ErrorCode::out_of_range,
                   fmt::format("calibrate: point {}: order U = {}, V = {} mm: must lie in the field of {} mm", i + 1,
                               point.order.u_mm, point.order.v_mm, request.field_mm)};
    }
  }
  if (points.size() < 3 || least_spread(points, request.field_mm) < 1e-6) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("calibrate: {} points: at least three are needed, not on one line", points.size())};
  }
  return {};
}

}  // namespace

Result<std::vector<MeasuredPoint>> parse_measured_points(std::string_view text) {
  std::vector<MeasuredPoint> points;
  GRAVURE_CHECK(read_csv_rows(
      text, {"measured points", "u_order, v_order, u_landing and v_landing in mm, four numbers and no more", 4},
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
    add_point(fit, grid, point);
  }
  add_bending(fit, grid, request.smoothing);
  const Eigen::MatrixXd errors = fit.solve();
  for (Eigen::Index i = 0; i < errors.rows(); ++i) {
    grid.errors.push_back({errors(i, 0), errors(i, 1)});
  }
  GRAVURE_CHECK(check_field_grid(grid));
  double squares = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    GRAVURE_TRY(const GridPoint landing, grid.lands_at(points[i].order));
    const double misfit_um =
        std::hypot(landing.u_mm - points[i].landing.u_mm, landing.v_mm - points[i].landing.v_mm) * kUmPerMm;
    squares += misfit_um * misfit_um;
    if (misfit_um > calibration.max_um) {
      calibration.max_um = misfit_um;
      calibration.worst = i;
    }
  }
  calibration.rms_um = std::sqrt(squares / static_cast<double>(points.size()));
  return calibration;
}

}  // namespace gravure::scan
