#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "gravure/kinematics/machine.hpp"

namespace gravure::kinematics {

/// What the spot must do, in the frame of the workpiece.
struct Target {
  Vector3 position_mm = Vector3::Zero();
  std::optional<Vector3> towards_head;  ///< direction of the beam; any length above 0. Absent: any direction will do
};

/// Which of two poses. A tilting axis: from where the turning axis and the beam are in line, the positive or the
/// negative way (for [A]: A >= 0 or A <= 0). A cylinder: the point on the side towards the head or away from it.
enum class Branch : std::uint8_t { positive, negative };

enum class Solver : std::uint8_t {
  linear,     ///< prismatic joints only
  cylinder,   ///< one rotary axis, one axis along it and one towards the head (or w)
  tilt_turn,  ///< two rotary axes at right angles under the workpiece, and the beam's direction
  numeric,    ///< damped Newton, for every other machine
};
std::string_view solver_name(Solver solver) noexcept;

struct InverseRequest {
  FieldPoint field;               ///< where in the field; w_mm holds where the joints can set the focus
  JointPositions near;            ///< turns, singular poses and the numeric search start here; empty: all 0
  std::vector<std::size_t> held;  ///< joints that stay where `near` has them
  Branch branch = Branch::positive;
};

struct Pose {
  JointPositions joints;
  FieldPoint field;  ///< as asked for, w_mm as found where the joints leave it open
  Solver solver = Solver::numeric;
  bool is_singular = false;  ///< a rotary axis was free to stand anywhere and was kept where it stood
};

/// The pose whose spot is the target. Closed form for flat, cylindrical and X-Y-Z-A-C machines ([A] eqs 6 to 10, [C2]
/// post-processor); a damped Newton search from `near` for every other chain.
///
/// Rotary axes come with the turns nearest to `near` that the limits allow (the tilting axis of a pair from -pi to pi).
/// At a pole (beam along the inner rotary axis, or a point on a cylinder's axis) the axis keeps its position. Where
/// the free joints cannot set the focus as well, w_mm is an outcome: the distance of the point from focus.
/// Fails with out_of_range where the target cannot be reached or a joint would leave its limits, with bad_argument for
/// a request that does not fit the machine.
Result<Pose> inverse(const Machine& machine, const Target& target, const InverseRequest& request);

/// `angle_rad` with the whole turns that bring it nearest to `near_rad`; half a turn off, the larger angle.
double nearest_turn(double angle_rad, double near_rad) noexcept;
/// The same among the turns that the limits allow; nearest_turn() where none is.
double allowed_turn(double angle_rad, double near_rad, const JointLimits& limits) noexcept;

}  // namespace gravure::kinematics
