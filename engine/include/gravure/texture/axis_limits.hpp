#pragma once

#include <vector>

#include "gravure/core/path_motion.hpp"
#include "gravure/kinematics/machine.hpp"

namespace gravure::texture {

/// How fast an axis may move, accelerate and change its acceleration: mm or rad per s, s^2 and s^3; all above 0.
struct AxisBounds {
  double speed = 0;
  double acceleration = 0;
  double jerk = 0;
};

/// In the order of kPathAxes: X, Y, Z, A, C, U, V and, where there is a focus axis, W.
using AxesLimits = std::vector<AxisBounds>;

inline bool has_focus_axis(const AxesLimits& limits) {
  return limits.size() > kFocusAxis;
}

/// The machine of [A] table 1, its jerk read as m/s^2 per ms. Accelerations and jerks of X, Y, U and V follow from the
/// published times of one step of the texture (89.84052 ms and 17.12208 ms); those of A and C are fitted to the times
/// with five axes (127.65 and 151.02 min), that of Z does not show in them and is half of X's. Speeds decide nothing
/// there and are not known: those here are what such axes reach. [A] has no focus axis.
AxesLimits published_limits();

/// The limits of a machine with joints X, Y, Z, A and C, in any order, and of its head; those it does not state, and W,
/// are taken from `otherwise`. out_of_range, with the axis, for a limit that is not above 0.
Result<AxesLimits> limits_of(const kinematics::Machine& machine, const AxesLimits& otherwise);

/// bad_argument unless there are seven or, with W, eight; out_of_range, with the axis, for one that is no number above
/// 0.
Result<void> check_limits(const AxesLimits& limits);

/// Where X-Y-Z-A-C machines put a point of the workpiece: head coordinates are
/// diag(1, sense, 1) Rx(sense A) Rz(sense C) (p - centre) - (X, Y, Z). sense is -1 for [A] eqs 6 to 13 (M), 1 for [C2].
struct RotaryTable {
  double sense = -1;
  kinematics::Vector3 centre_mm = kinematics::Vector3::Zero();
  /// p in head coordinates with X, Y and Z at 0; the third is towards the head.
  kinematics::Vector3 turned(double a_rad, double c_rad, const kinematics::Vector3& p) const noexcept;
  /// The beam in the workpiece's frame, towards the head.
  kinematics::Vector3 beam(double a_rad, double c_rad) const noexcept;
};

/// Fails with bad_argument for a machine that is not as kinematics::xyzac_machine() makes them with a telecentric lens.
Result<RotaryTable> rotary_table(const kinematics::Machine& machine);

}  // namespace gravure::texture
