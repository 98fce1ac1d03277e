#include "gravure/motion/blade_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "check_request.hpp"
#include "gravure/core/csv_rows.hpp"
#include "vector3.hpp"

namespace gravure::motion {
namespace {

constexpr double kMostPoints = 5e6;
constexpr double kMostCoordinate_mm = 1e6;

/// The span of a Catmull-Rom curve that holds a parameter; the ends are continued straight.
struct Span {
  std::array<Vector3, 4> p{};
  double t = 0;

  Span(const std::vector<Vector3>& points, double parameter) {
    const auto spans = static_cast<double>(points.size() - 1);
    const double from = std::clamp(std::floor(parameter), 0.0, spans - 1);
    t = parameter - from;
    const auto k = static_cast<std::size_t>(from);
    p[1] = points[k];
    p[2] = points[k + 1];
    for (std::size_t i = 0; i < 3; ++i) {
      p[0][i] = k > 0 ? points[k - 1][i] : 2 * p[1][i] - p[2][i];
      p[3][i] = k + 2 < points.size() ? points[k + 2][i] : 2 * p[2][i] - p[1][i];
    }
  }

  Vector3 weighed(const std::array<double, 4>& weights) const noexcept {
    Vector3 sum{};
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        sum[i] += weights[k] * p[k][i];
      }
    }
    return sum;
  }
};

/// Largest distances of neighbours in a grid of sample_sides(), along the curves and across.
std::pair<double, double> gaps_of(const std::vector<Vector3>& points, std::size_t across) {
  double along_mm = 0;
  double across_mm = 0;
  const std::size_t row = 2 * across;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + row < points.size()) {
      along_mm = std::max(along_mm, distance(points[i], points[i + row]));
    }
    if (i % row + 2 < row) {
      across_mm = std::max(across_mm, distance(points[i], points[i + 2]));
    }
  }
  return {along_mm, across_mm};
}

Error too_many(const BladeSampling& sampling) {
  return Error{ErrorCode::out_of_range,
               fmt::format("blade: spacing_mm = {}: {} blades would need more than {:g} points; widen it",
                           sampling.spacing_mm, sampling.blades, kMostPoints)};
}

/// More samples in a row where neighbours are too far apart.
double finer(double count, double gap_mm, double spacing_mm) noexcept {
  return gap_mm > spacing_mm ? std::max(count + 1, 1 + std::ceil((count - 1) * gap_mm / spacing_mm)) : count;
}

/// One blade, ever finer until no gap is wider than the spacing.
Result<std::vector<Vector3>> one_blade(const BladeRails& rails, const BladeSampling& sampling) {
  const RuledBlade blade{curve_through(rails.shroud), curve_through(rails.hub), sampling.thickness_mm};
  const auto last = static_cast<double>(rails.shroud.size() - 1);
  double along = 2;
  double across = 2;
  while (2 * along * across * static_cast<double>(sampling.blades) <= kMostPoints) {
    const auto columns = static_cast<std::size_t>(across);
    std::vector<Vector3> points = sample_sides(blade, 0, last, static_cast<std::size_t>(along), columns);
    const auto [along_mm, across_mm] = gaps_of(points, columns);
    if (along_mm <= sampling.spacing_mm && across_mm <= sampling.spacing_mm) {
      return points;
    }
    along = finer(along, along_mm, sampling.spacing_mm);
    across = finer(across, across_mm, sampling.spacing_mm);
  }
  return too_many(sampling);
  // std::function frees its copy through a pointer that the analyser does not follow.
}  // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks)

}  // namespace

Curve curve_through(std::vector<Vector3> points) {
  Curve curve;
  curve.at = [points](double u) {
    const Span span(points, u);
    const double t = span.t;
    return span.weighed({t * (-0.5 + t * (1 - t / 2)), 1 + t * t * (1.5 * t - 2.5), t * (0.5 + t * (2 - 1.5 * t)),
                         t * t * (t - 1) / 2});
  };
  curve.slope = [points = std::move(points)](double u) {
    const Span span(points, u);
    const double t = span.t;
    return span.weighed({-0.5 + t * (2 - 1.5 * t), t * (4.5 * t - 5), 0.5 + t * (4 - 4.5 * t), t * (1.5 * t - 1)});
  };
  return curve;
}

Result<BladeRails> parse_blade_csv(std::string_view text) {
  BladeRails rails;
  GRAVURE_CHECK(
      read_csv_rows(text, {"blade", "x, y, z of the shroud and x, y, z of the hub in mm, six numbers and no more", 6},
                    [&rails](std::span<const double> row) {
                      rails.shroud.push_back({row[0], row[1], row[2]});
                      rails.hub.push_back({row[3], row[4], row[5]});
                    }));
  if (rails.shroud.size() < 2) {
    return Error{ErrorCode::bad_file, fmt::format("blade: {} rows: 2 or more are needed", rails.shroud.size())};
  }
  return rails;
}

Result<std::vector<Vector3>> blade_points(const BladeRails& rails, const BladeSampling& sampling) {
  GRAVURE_CHECK(check_range("blade rows", static_cast<double>(rails.shroud.size()), 2, 1e7));
  GRAVURE_CHECK(check_range("blade rows of the hub", static_cast<double>(rails.hub.size()),
                            static_cast<double>(rails.shroud.size()), static_cast<double>(rails.shroud.size())));
  GRAVURE_CHECK(check_range("blade thickness_mm", sampling.thickness_mm, 0, 1e4));
  GRAVURE_CHECK(check_range("blades", static_cast<double>(sampling.blades), 1, 1000));
  GRAVURE_CHECK(check_range("blade spacing_mm", sampling.spacing_mm, 1e-3, 1e4));
  for (const std::vector<Vector3>* rail : {&rails.shroud, &rails.hub}) {
    for (const Vector3& point : *rail) {
      const double furthest = std::max({std::abs(point[0]), std::abs(point[1]), std::abs(point[2])});
      GRAVURE_CHECK(check_range("blade coordinate in mm", furthest, 0, kMostCoordinate_mm));
    }
  }
  GRAVURE_TRY(std::vector<Vector3> points, one_blade(rails, sampling));
  const std::size_t of_one = points.size();
  points.reserve(of_one * sampling.blades);
  const Vector3& centre = sampling.centre_mm;
  for (std::size_t k = 1; k < sampling.blades; ++k) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(sampling.blades);
    const double c = std::cos(turn);
    const double s = std::sin(turn);
    for (std::size_t i = 0; i < of_one; ++i) {
      const double x = points[i][0] - centre[0];
      const double y = points[i][1] - centre[1];
      points.push_back({centre[0] + c * x - s * y, centre[1] + s * x + c * y, points[i][2]});
    }
  }
  return points;
}

}  // namespace gravure::motion
