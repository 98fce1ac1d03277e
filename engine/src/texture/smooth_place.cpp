#include "smooth_place.hpp"

#include <algorithm>
#include <cmath>

namespace gravure::texture {
namespace {

template <std::size_t Size>
double dot(const std::array<double, 6>& values, const std::array<double, Size>& weights) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < Size; ++i) {
    sum += values[i] * weights[i];
  }
  return sum;
}

/// The control points of a cell, less the whole number below the first.
double split_off(std::array<double, 6>& values) noexcept {
  const double base = std::floor(values[0]);
  for (double& value : values) {
    value -= base;
  }
  return base;
}

Place place_of(double base, double rest, std::size_t points) noexcept {
  const double whole = std::floor(rest);
  const auto index = static_cast<std::size_t>(std::max(base + whole, 0.0));
  return index + 1 < points ? Place{index, rest - whole} : Place{points - 2, 1};
}

}  // namespace

SmoothPlace::SmoothPlace(std::vector<double> means, std::int64_t cell, std::size_t points)
    : cell_(cell), points_(points) {
  constexpr std::size_t kPad = 2 * kReach;
  means_.assign(kPad, 0.0);
  means_.insert(means_.end(), means.begin(), means.end());
  means_.insert(means_.end(), kPad, means.back());
  weights_.reserve(static_cast<std::size_t>(cell));
  for (std::int64_t k = 0; k < cell; ++k) {
    weights_.push_back(spline_weights<5>(static_cast<double>(k) / static_cast<double>(cell)));
  }
}

Place SmoothPlace::at(std::int64_t period) const noexcept {
  const std::int64_t shifted = period + 2 * kReach * cell_;
  const std::int64_t j = std::clamp<std::int64_t>(shifted / cell_, 2, static_cast<std::int64_t>(means_.size()) - 4);
  const std::int64_t phase = std::clamp<std::int64_t>(shifted - j * cell_, 0, cell_ - 1);
  std::array<double, 6> c{};
  std::copy_n(&means_[static_cast<std::size_t>(j - 2)], 6, c.begin());
  const double base = split_off(c);
  return place_of(base, dot(c, weights_[static_cast<std::size_t>(phase)]), points_);
}

PlaceState SmoothPlace::state(double period, double period_s) const noexcept {
  const double shifted = period / static_cast<double>(cell_) + static_cast<double>(2 * kReach);
  const double cell = std::clamp(std::floor(shifted), 2.0, static_cast<double>(means_.size() - 4));
  const double share = std::clamp(shifted - cell, 0.0, 1.0);
  std::array<double, 6> c{};
  std::copy_n(&means_[static_cast<std::size_t>(cell) - 2], 6, c.begin());
  const double by = 1 / (static_cast<double>(cell_) * period_s);
  PlaceState state;
  const double base = split_off(c);
  const auto second = spline_weights<2>(share);
  const auto third = raised<3>(second, share);
  const auto fourth = raised<4>(third, share);
  state.place = place_of(base, dot(c, raised<5>(fourth, share)), points_);
  const auto differences = [&c, by](std::size_t left) {
    for (std::size_t i = 0; i < left; ++i) {
      c[i] = (c[i + 1] - c[i]) * by;
    }
  };
  differences(5);
  state.speed = dot(c, fourth);
  differences(4);
  state.acceleration = dot(c, third);
  differences(3);
  state.jerk = dot(c, second);
  return state;
}

}  // namespace gravure::texture
