#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "gravure/texture/axes.hpp"
#include "path_axes.hpp"

namespace gravure::texture {

using StageValues = std::array<double, kStageAxes>;

/// Stages and their derivatives by the number of the point.
struct StageState {
  StageValues value{};
  StageValues first{};
  StageValues second{};
  StageValues third{};
};

/// The stages between the points of a path: cubic splines through them, natural at each of `breaks` (rising, both ends
/// among them), so with every point a break straight lines.
class StageSpline {
 public:
  StageSpline() = default;
  StageSpline(std::span<const SevenAxes> axes, std::span<const std::size_t> breaks);
  StageValues at(const Place& place) const noexcept;
  StageState state(const Place& place) const noexcept;

 private:
  struct Knot {
    StageValues value;
    StageValues bend;  ///< second derivative
  };
  static void solve(std::vector<Knot>& knots, std::size_t first, std::size_t last);
  std::shared_ptr<const std::vector<Knot>> knots_;  ///< copies of a spline share them
};

}  // namespace gravure::texture
