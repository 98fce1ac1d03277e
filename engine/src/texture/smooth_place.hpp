#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "path_axes.hpp"

namespace gravure::texture {

/// From the weights of a uniform B-spline of one degree less, `share` 0 to 1 into the cell.
template <std::size_t Degree>
std::array<double, Degree + 1> raised(const std::array<double, Degree>& below, double share) noexcept {
  std::array<double, Degree + 1> weights{};
  constexpr auto kBy = static_cast<double>(Degree);
  for (std::size_t i = 0; i <= Degree; ++i) {
    const double before = i > 0 ? below[i - 1] : 0;
    const double here = i < Degree ? below[i] : 0;
    const auto k = static_cast<double>(i);
    weights[i] = ((kBy - k + share) * before + (k + 1 - share) * here) / kBy;
  }
  return weights;
}

/// The weights of the degree + 1 control points of a uniform B-spline, `share` 0 to 1 into the cell.
template <std::size_t Degree>
std::array<double, Degree + 1> spline_weights(double share) noexcept {
  if constexpr (Degree == 0) {
    return {1.0};
  } else {
    return raised<Degree>(spline_weights<Degree - 1>(share), share);
  }
}

/// A place along the path and its derivatives by time.
struct PlaceState {
  Place place;
  double speed = 0;
  double acceleration = 0;
  double jerk = 0;
};

/// Where the stages are along the path at each period: a uniform B-spline of degree 5 (its jerk is continuous) whose
/// control points are means of the texture's own place over `cell` periods each. A mean of means: place, speed,
/// acceleration and jerk stay between the texture's, and stand still for ever outside.
class SmoothPlace {
 public:
  static constexpr std::int64_t kReach = 3;  ///< cells that a control point reaches to either side

  SmoothPlace() = default;
  /// `means[k]`: mean over periods (k - 1/2) cell to (k + 1/2) cell, period 0 the start; before the first and after the
  /// last the path's ends, 0 and `points` - 1.
  SmoothPlace(std::vector<double> means, std::int64_t cell, std::size_t points);
  Place at(std::int64_t period) const noexcept;
  PlaceState state(double period, double period_s) const noexcept;
  /// The place rests from here on.
  std::int64_t end() const noexcept { return (static_cast<std::int64_t>(means_.size()) - 1 - 3 * kReach) * cell_; }
  std::int64_t cell() const noexcept { return cell_; }

 private:
  std::vector<double> means_;                   ///< from 2 kReach cells before the start
  std::vector<std::array<double, 6>> weights_;  ///< by period of the cell
  std::int64_t cell_ = 1;
  std::size_t points_ = 2;
};

}  // namespace gravure::texture
