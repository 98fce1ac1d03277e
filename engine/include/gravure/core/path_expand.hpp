#pragma once

#include <array>

namespace gravure {

/// How an axis moves between two set-points of a path: the cubic through the four nearest, x[0] one period before the
/// begin, x[1] at it, x[2] at its end, x[3] one after; at the ends of the path the outer one is a repetition of its
/// neighbour, because the axes rest there. Its acceleration goes straight from one second difference to the next and
/// its jerk is the third difference, each a mean of what the planned motion does round there:
/// so a motion within its limits stays within them here.
struct CubicMotion {
  double position = 0;
  double speed = 0;         ///< a period
  double acceleration = 0;  ///< a period squared
  double jerk = 0;          ///< a period cubed
};

/// `share` 0 to 1 of the period from x[1] to x[2]. Newton's form, exact where the four are equal.
inline CubicMotion cubic_motion(const std::array<double, 4>& x, double share) {
  const double first = x[2] - x[1];
  const double before = x[2] - 2 * x[1] + x[0];
  const double after = x[3] - 2 * x[2] + x[1];
  const double jerk = after - before;
  // x1 + first s + s (s - 1) / 2 * before + (s + 1) s (s - 1) / 6 * jerk
  CubicMotion motion;
  motion.position = x[1] + share * (first + (share - 1) * (before / 2 + (share + 1) * jerk / 6));
  motion.speed = first + (2 * share - 1) / 2 * before + (3 * share * share - 1) / 6 * jerk;
  motion.acceleration = before + share * jerk;
  motion.jerk = jerk;
  return motion;
}

inline double cubic_between(const std::array<double, 4>& x, double share) {
  return cubic_motion(x, share).position;
}

}  // namespace gravure
