#include "path_spline.hpp"

namespace gravure::texture {

StageSpline::StageSpline(std::span<const SevenAxes> axes, std::span<const std::size_t> breaks) {
  std::vector<Knot> knots;
  knots.reserve(axes.size());
  for (const SevenAxes& at : axes) {
    knots.push_back({stages_of(at), {}});
  }
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    solve(knots, breaks[k], breaks[k + 1]);
  }
  knots_ = std::make_shared<const std::vector<Knot>>(std::move(knots));
}

/// bend[i - 1] + 4 bend[i] + bend[i + 1] = 6 times the second difference, 0 at both ends: one sweep down, one up.
void StageSpline::solve(std::vector<Knot>& knots, std::size_t first, std::size_t last) {
  if (last - first < 2) {
    return;
  }
  std::vector<double> upper(last - first, 0.0);
  for (std::size_t i = first + 1; i < last; ++i) {
    const double pivot = 4 - (i > first + 1 ? upper[i - 1 - first] : 0);
    upper[i - first] = 1 / pivot;
    for (std::size_t axis = 0; axis < kStageAxes; ++axis) {
      const double rest = 6 * (knots[i + 1].value[axis] - 2 * knots[i].value[axis] + knots[i - 1].value[axis]) -
                          knots[i - 1].bend[axis];
      knots[i].bend[axis] = rest / pivot;
    }
  }
  for (std::size_t i = last - 1; i > first; --i) {
    for (std::size_t axis = 0; axis < kStageAxes; ++axis) {
      knots[i].bend[axis] -= i + 1 < last ? upper[i - first] * knots[i + 1].bend[axis] : 0;
    }
  }
}

StageValues StageSpline::at(const Place& place) const noexcept {
  const std::size_t i = place.index;
  const double u = place.share;
  const double w = 1 - u;
  const double low = w * (w * w - 1) / 6;
  const double high = u * (u * u - 1) / 6;
  const Knot& a = (*knots_)[i];
  const Knot& b = (*knots_)[i + 1];
  StageValues value;
  for (std::size_t axis = 0; axis < kStageAxes; ++axis) {
    value[axis] = a.value[axis] + u * (b.value[axis] - a.value[axis]) + (low * a.bend[axis] + high * b.bend[axis]);
  }
  return value;
}

StageState StageSpline::state(const Place& place) const noexcept {
  const std::size_t i = place.index;
  const double u = place.share;
  const double w = 1 - u;
  const Knot& a = (*knots_)[i];
  const Knot& b = (*knots_)[i + 1];
  StageState state;
  state.value = at(place);
  for (std::size_t axis = 0; axis < kStageAxes; ++axis) {
    state.first[axis] =
        b.value[axis] - a.value[axis] - (3 * w * w - 1) / 6 * a.bend[axis] + (3 * u * u - 1) / 6 * b.bend[axis];
    state.second[axis] = w * a.bend[axis] + u * b.bend[axis];
    state.third[axis] = b.bend[axis] - a.bend[axis];
  }
  return state;
}

}  // namespace gravure::texture
