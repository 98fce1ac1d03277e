#pragma once

#include <vector>

#include "gravure/core/path_motion.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/texture/axis_limits.hpp"

namespace gravure::texture {

/// The position loop of an axis as a system of second order without feed-forward: where it stands is its set-point
/// through omega^2 / (s^2 + 2 damping omega s + omega^2), omega = 2 pi natural_hz.
struct ServoLoop {
  double natural_hz = 0;
  double damping = 0;
};
/// In the order of kPathAxes, with W or without.
using AxesServos = std::vector<ServoLoop>;

/// What such axes have where nobody has measured them: 50 Hz of X, Y and Z, 30 of A and C, 1000 of the galvo; damping
/// 0.7. [A] says nothing of them. A focus axis is a carriage on a screw, too: as X, Y and Z.
AxesServos assumed_servos(bool focus_axis = false);

/// bad_argument unless there are seven or, with W, eight; out_of_range, with the axis, for a loop that is not above 0
/// and at most 1 MHz with a damping of at most 100.
Result<void> check_servos(const AxesServos& servos);

/// How far something is behind where it is ordered to be.
struct FollowingError {
  double max = 0;            ///< magnitude
  double rms = 0;            ///< over all set-points
  std::int64_t instant = 0;  ///< where it is largest, set-point
};

struct FollowingErrors {
  std::vector<FollowingError> axes;  ///< those of the servos; mm, A and C in rad
  FollowingError spot_mm;            ///< of the light across the beam, all axes together
  FollowingError focus_mm;           ///< of the surface along the beam
};

/// What loops make of a motion, from rest on its first set-point: set-points are joined by the cubics of
/// cubic_motion(), and between two of them the loop's equation is solved in closed form, so the servo period adds no
/// error of its own. Spot and focus follow from the axes to first order. Errors as check_servos() and
/// PathMotion::read(); cancelled on request.
Result<FollowingErrors> predict_following(const PathMotion& motion, const AxesServos& servos, const RotaryTable& table,
                                          double servo_s, const CancelToken& cancel);

}  // namespace gravure::texture
