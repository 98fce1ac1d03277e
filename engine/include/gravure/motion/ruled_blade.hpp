#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gravure/motion/five_axis.hpp"

namespace gravure::motion {

/// A curve with its derivative.
struct Curve {
  std::function<Vector3(double)> at;
  std::function<Vector3(double)> slope;
};

/// A blade ruled between two curves ([C2] eqs 1 to 3): R(u, v) = (1 - v) P(u) + v Q(u), its two sides half the
/// thickness away along the normal R_u x R_v, and the hub swept by the foot curve Q about z.
struct RuledBlade {
  Curve shroud;  ///< P
  Curve hub;     ///< Q
  double thickness_mm = 0;

  Vector3 middle(double u, double v) const;
  /// `which` +1 or -1. Where the ruling lies along the curves there is no normal; the middle is returned.
  Vector3 side(double u, double v, int which) const;
  /// The foot curve turned by `angle_rad` about z.
  Vector3 hub_surface(double u, double angle_rad) const;
};

/// Points of both sides, `along` by `across` of them over [u_from, u_to] x [0, 1].
std::vector<Vector3> sample_sides(const RuledBlade& blade, double u_from, double u_to, std::size_t along,
                                  std::size_t across);

/// Points of a surface from elsewhere: x, y and z in mm in the workpiece's frame, in the form of parse_recording_csv().
Result<std::vector<Vector3>> parse_points_csv(std::string_view text);

/// What must not touch the blades: a cylinder (or cone) about the tool axis, or the cone of a focused beam.
struct ToolShape {
  double radius_mm = 0;      ///< at the tip
  double widening = 0;       ///< radius gained per mm along the axis; the tangent of a cone's half angle
  double length_mm = 0;      ///< from the tip
  double clear_from_mm = 0;  ///< below this height along the axis contact is wanted, not counted
};

struct Interference {
  bool touches = false;
  double depth_mm = 0;    ///< how far the deepest point lies inside; negative is the clearance
  std::size_t point = 0;  ///< the deepest (or nearest)
  double height_mm = 0;   ///< of it along the axis
  std::size_t place = 0;  ///< of the tool, where there are several
};

/// Distance of each point from the axis against the radius there. `margin_mm` is added to the radius: half the spacing
/// of sampled surfaces covers what lies between the points.
Interference find_interference(const ToolPose& tool, const ToolShape& shape, std::span<const Vector3> points,
                               double margin_mm = 0);
/// The deepest of a tool at several places.
Interference find_interference(std::span<const ToolPose> places, const ToolShape& shape,
                               std::span<const Vector3> points, double margin_mm = 0);

/// Turning c out of the way ([C2]): what was tried.
struct Cleared {
  double c_rad = 0;       ///< that is free
  double turned_rad = 0;  ///< from the wanted one
};

/// Which way to turn first; both are tried at every step.
enum class TurnFirst : std::int8_t { up = 1, down = -1 };

/// The nearest free c by increments to either side, up to `c_most_rad` ([C2]: 1 to 2 degrees a step), the ball (or
/// focus) held where it is. `places`, one or more, are where the tool goes with one and the same axis: all become free.
/// Fails with out_of_range, naming the depth that is left, where no c frees them: a slimmer tool or another tilt is
/// needed.
Result<Cleared> turn_clear(std::span<const ToolPose> places, const ToolShape& shape, std::span<const Vector3> points,
                           double margin_mm, double ball_radius_mm, double c_step_rad, double c_most_rad,
                           TurnFirst first = TurnFirst::up);

}  // namespace gravure::motion
