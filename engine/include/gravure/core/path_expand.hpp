#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "gravure/core/program.hpp"

namespace gravure {

/// The four set-points round a servo period: one before its begin, at its begin, at its end, one after. At the ends of
/// a path the outer one repeats its neighbour, because the axes rest there.
using PathWindow = std::array<PathSetPoint, 4>;

/// What an axis does at a moment; counts, and counts over powers of the period.
struct CubicMotion {
  double position = 0;
  double speed = 0;
  double acceleration = 0;
  double jerk = 0;
};

/// How an axis moves between two set-points of a path: the cubic through the four nearest, here by the first and the
/// differences of the following ones. `share` is 0 to 1 of the period from the second to the third. Its acceleration
/// goes straight from one second difference to the next, its jerk is the third difference: each a mean of what the
/// planned motion does round there, so that a motion within its limits keeps within them here.
inline CubicMotion cubic_motion(double begin, const std::array<double, 3>& differences, double share) {
  const double first = differences[1];
  const double before = first - differences[0];
  const double jerk = differences[2] - first - before;
  CubicMotion motion;
  motion.position = begin + share * (first + (share - 1) * (before / 2 + (share + 1) * jerk / 6));
  motion.speed = first + (2 * share - 1) / 2 * before + (3 * share * share - 1) / 6 * jerk;
  motion.acceleration = before + share * jerk;
  motion.jerk = jerk;
  return motion;
}

inline CubicMotion cubic_motion(const std::array<double, 4>& x, double share) {
  return cubic_motion(x[1], {x[1] - x[0], x[2] - x[1], x[3] - x[2]}, share);
}

inline double cubic_between(const std::array<double, 4>& x, double share) {
  return cubic_motion(x, share).position;
}

/// Of an axis of set-points; differences are taken of integers, exactly.
inline CubicMotion axis_motion(const PathWindow& window, std::size_t axis, double share) {
  const auto apart = [&](std::size_t i) {
    return static_cast<double>(window[i + 1].counts[axis] - window[i].counts[axis]);
  };
  return cubic_motion(static_cast<double>(window[1].counts[axis]), {apart(0), apart(1), apart(2)}, share);
}

/// The path covered meanwhile, counts from the begin of the period: the cubic with the slopes of the neighbours'
/// secants, no steeper than three times the secants beside it, so that it never runs backwards and stands still where
/// no path is covered (Fritsch and Carlson 1980).
class CoveredPath {
 public:
  explicit CoveredPath(const PathWindow& window) {
    const auto apart = [&window](std::size_t i) {
      return static_cast<double>(window[i + 1].along_counts - window[i].along_counts);
    };
    covered_ = apart(1);
    begin_slope_ = slope(apart(0), covered_);
    end_slope_ = slope(covered_, apart(2));
  }
  double covered() const noexcept { return covered_; }
  double at(double share) const noexcept {
    const double rest = 1 - share;
    return share * share * (3 - 2 * share) * covered_ + share * rest * (rest * begin_slope_ - share * end_slope_);
  }
  /// The greatest speed in the period, counts a period: that of an end, or between them where the speed bends down.
  double max_speed() const noexcept {
    const double ends = std::max(begin_slope_, end_slope_);
    const double bend = 2 * covered_ - begin_slope_ - end_slope_;
    const double rise = 3 * covered_ - 2 * begin_slope_ - end_slope_;
    if (!(rise > 0 && rise < 3 * bend)) {  // the top of the parabola is not inside
      return ends;
    }
    return std::max(ends, begin_slope_ + rise * rise / (3 * bend));
  }
  /// The share of the period after which `counts` are covered, 0 <= counts <= covered(), covered() above 0.
  double share_of(double counts) const noexcept {
    double low = 0;
    double high = 1;
    constexpr int kHalvings = 52;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (low + high) / 2;
      (at(middle) < counts ? low : high) = middle;
    }
    return (low + high) / 2;
  }

 private:
  static double slope(double left, double right) { return std::min({(left + right) / 2, 3 * left, 3 * right}); }

  double covered_ = 0;
  double begin_slope_ = 0;
  double end_slope_ = 0;
};

}  // namespace gravure
