#include "path_rows.hpp"

#include <array>
#include <cmath>
#include <string>

#include "column_table.hpp"

namespace gravure::grv {
namespace {

constexpr double kCountsPerMm = 1e9;
constexpr double kCountsOfOne = 1e12;
constexpr double kMost = 4e18;  // in 63 bits

using TargetNumbers = std::array<double, 7>;

TargetNumbers numbers_of(const PathTarget& target) {
  return {target.along_mm * kCountsPerMm,       target.position_mm[0] * kCountsPerMm,
          target.position_mm[1] * kCountsPerMm, target.position_mm[2] * kCountsPerMm,
          target.normal[0] * kCountsOfOne,      target.normal[1] * kCountsOfOne,
          target.normal[2] * kCountsOfOne};
}

}  // namespace

std::vector<std::int64_t> rows_of(std::span<const PathSetPoint> points, bool focus_axis) {
  std::vector<std::int64_t> rows;
  const std::size_t columns = set_point_columns(focus_axis).columns;
  rows.reserve(points.size() * columns);
  for (const PathSetPoint& point : points) {
    rows.insert(rows.end(), point.counts.begin(), point.counts.begin() + static_cast<std::ptrdiff_t>(columns - 1));
    rows.push_back(point.along_counts);
  }
  return rows;
}

void set_points_from(std::span<const std::int64_t> rows, bool focus_axis, std::span<PathSetPoint> out) {
  const std::size_t axes = set_point_columns(focus_axis).columns - 1;
  auto next = rows.begin();
  for (PathSetPoint& point : out) {
    point = {};
    for (std::size_t axis = 0; axis < axes; ++axis) {
      point.counts[axis] = *next++;
    }
    point.along_counts = *next++;
  }
}

Result<std::vector<std::int64_t>> rows_of(std::span<const PathTarget> targets) {
  std::vector<std::int64_t> rows;
  rows.reserve(targets.size() * target_columns().columns);
  for (const PathTarget& target : targets) {
    for (const double number : numbers_of(target)) {
      if (!(std::abs(number) <= kMost)) {
        return Error{ErrorCode::bad_argument,
                     "a wanted point at " + std::to_string(target.along_mm) + " mm of the path is beyond 4e9 mm"};
      }
      rows.push_back(std::llround(number));
    }
  }
  return rows;
}

void targets_from(std::span<const std::int64_t> rows, std::span<PathTarget> out) {
  auto next = rows.begin();
  const auto mm = [&next] { return static_cast<double>(*next++) / kCountsPerMm; };
  for (PathTarget& target : out) {
    target.along_mm = mm();
    for (double& position : target.position_mm) {
      position = mm();
    }
    for (double& part : target.normal) {
      part = static_cast<double>(*next++) / kCountsOfOne;
    }
  }
}

}  // namespace gravure::grv
