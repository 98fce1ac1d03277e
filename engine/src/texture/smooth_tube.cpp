#include "smooth_tube.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gravure::texture {
namespace {

constexpr std::array<double, 4> kThird = {-1, 3, -3, 1};
/// Below this a wave has more than 200 knots, and the normal equations lose more than half of their digits.
constexpr double kLeastStiffness = 1e-9;
constexpr double kMostStiffness = 64;  // the square of the sharpest third difference

}  // namespace

SmoothTube::SmoothTube(std::span<const Vector2> path_mm, std::vector<double> radius_mm)
    : path_mm_(path_mm),
      radius_mm_(std::move(radius_mm)),
      smooth_(path_mm.size(), Vector2::Zero()),
      bounded_(smooth_),
      pull_(smooth_) {
  constexpr std::size_t kWider = 4;
  constexpr std::size_t kLeastKnots = 64;  // twice as far as the least stiffness holds a point
  for (std::size_t spacing = 1; path_mm_.size() > 3; spacing *= kWider) {
    space_knots(spacing);
    stiffness_ = first_stiffness();
    if (stiffness_ > 2 * kLeastStiffness || spacing * kWider * kLeastKnots > path_mm_.size()) {
      break;
    }
  }
  for (std::size_t i = 0; i < smooth_.size(); ++i) {
    bounded_[i] = inside(i, smooth_[i]);
  }
}

void SmoothTube::space_knots(std::size_t spacing) {
  spacing_ = spacing;
  weights_.resize(spacing);
  for (std::size_t i = 0; i < spacing; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(spacing);
    const double r = 1 - t;
    weights_[i] = {r * r * r / 6, (4 - 6 * t * t + 3 * t * t * t) / 6, (4 - 6 * r * r + 3 * r * r * r) / 6,
                   t * t * t / 6};
  }
  controls_.assign(first_control(path_mm_.size() - 1) + 4, Vector2::Zero());
}

/// D'D + stiffness B'B: third differences of control points, points by control points.
Banded SmoothTube::normal_matrix(double stiffness) const {
  Banded matrix(controls_.size());
  const auto add = [&matrix](std::size_t first, const std::array<double, 4>& row, double factor) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t l = k; l < 4; ++l) {
        matrix.at(first + k, l - k) += factor * row[k] * row[l];
      }
    }
  };
  for (std::size_t j = 0; j + 3 < controls_.size(); ++j) {
    add(j, kThird, 1);
  }
  for (std::size_t i = 0; i < path_mm_.size(); ++i) {
    add(first_control(i), weights(i), stiffness / static_cast<double>(spacing_));
  }
  return matrix;
}

void SmoothTube::fit(const Banded& factored, double stiffness) {
  std::fill(controls_.begin(), controls_.end(), Vector2::Zero());
  const double factor = stiffness / static_cast<double>(spacing_);
  for (std::size_t i = 0; i < path_mm_.size(); ++i) {
    const Vector2 wanted = factor * (path_mm_[i] + bounded_[i] - pull_[i]);
    for (std::size_t k = 0; k < 4; ++k) {
      controls_[first_control(i) + k] += weights(i)[k] * wanted;
    }
  }
  factored.solve_factored(controls_);
  for (std::size_t i = 0; i < path_mm_.size(); ++i) {
    const Vector2* control = controls_.data() + first_control(i);
    const std::array<double, 4>& w = weights(i);
    smooth_[i] = w[0] * control[0] + w[1] * control[1] + w[2] * control[2] + w[3] * control[3] - path_mm_[i];
  }
}

Vector2 SmoothTube::inside(std::size_t point, const Vector2& apart_mm) const {
  const double norm = apart_mm.norm();
  return norm > radius_mm_[point] ? Vector2(apart_mm * (radius_mm_[point] / norm)) : apart_mm;
}

double SmoothTube::reach() const {
  double most = 0;
  for (std::size_t i = 0; i < smooth_.size(); ++i) {
    most = std::max(most, smooth_[i].norm() / radius_mm_[i]);
  }
  return most;
}

double SmoothTube::first_stiffness() {
  double low = std::log(kLeastStiffness);
  double high = std::log(kMostStiffness);
  constexpr int kHalvings = 12;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    Banded matrix = normal_matrix(std::exp(middle));
    matrix.factor();
    fit(matrix, std::exp(middle));
    (reach() > 1 ? low : high) = middle;
  }
  return std::exp(high);
}

void SmoothTube::improve(int steps) {
  if (path_mm_.size() < 4) {
    return;  // no third difference: nothing to gain
  }
  constexpr double kFurther = 1.6;  // over-relaxation, between 1.5 and 1.8 as usual
  Banded matrix = normal_matrix(stiffness_);
  matrix.factor();
  double apart = 0;
  double moved = 0;
  for (int step = 0; step < steps; ++step) {
    fit(matrix, stiffness_);
    apart = 0;
    moved = 0;
    for (std::size_t i = 0; i < smooth_.size(); ++i) {
      const Vector2 ahead = kFurther * smooth_[i] + (1 - kFurther) * bounded_[i];
      const Vector2 before = bounded_[i];
      bounded_[i] = inside(i, ahead + pull_[i]);
      pull_[i] += ahead - bounded_[i];
      apart += (smooth_[i] - bounded_[i]).squaredNorm();
      moved += (bounded_[i] - before).squaredNorm();
    }
  }
  balance(std::sqrt(apart), std::sqrt(moved));
}

void SmoothTube::balance(double apart_mm, double moved_mm) {
  constexpr double kLag = 3;
  constexpr double kMost = 10;
  const double lag = apart_mm / std::max(moved_mm, 1e-300);
  const double change = lag > kLag || lag < 1 / kLag ? std::clamp(std::sqrt(lag), 1 / kMost, kMost) : 1;
  const double next = std::clamp(stiffness_ * change, kLeastStiffness, kMostStiffness);
  for (Vector2& pull : pull_) {
    pull *= stiffness_ / next;
  }
  stiffness_ = next;
}

}  // namespace gravure::texture
