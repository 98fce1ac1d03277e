#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::motion {

using Vector3 = std::array<double, 3>;

/// Where the axes of an XYZAC machine stand. Sense of the angles: (X, Y, Z) = Rx(a) Rz(c) (p - L), L the intersection
/// of the rotary axes in the workpiece's frame ([C2] post-processor; the source leaves the sense open). Four poses: a
/// tool along +z has a = 0 and any c; along +y a = 90, c = 0; along +x a = 90, c = 90; along -y a = 90, c = 180
/// degrees.
struct AxisPose {
  double x_mm = 0;
  double y_mm = 0;
  double z_mm = 0;
  double a_rad = 0;
  double c_rad = 0;  ///< with its turns
};

/// Tool (or beam) centre and direction in the workpiece's frame.
struct ToolPose {
  Vector3 centre_mm{};
  Vector3 axis{};  ///< any length above 0, pointing away from the workpiece
};

enum class Branch : std::uint8_t { positive_a, negative_a };

/// The machine's axes for a tool pose: a = atan2(hypot(Tx, Ty), Tz), c = atan2(Tx, Ty), or the other branch (-a, c +
/// pi). c comes with the turns nearest to `c_before_rad`; at the pole (Tx = Ty = 0), where any c does, it keeps that
/// value.
AxisPose axes_of(const ToolPose& tool, const Vector3& rotary_centre_mm, Branch branch, double c_before_rad = 0);

/// The same for angles that are chosen already.
AxisPose axes_at(const Vector3& centre_mm, const Vector3& rotary_centre_mm, double a_rad, double c_rad) noexcept;

/// Back into the workpiece's frame; the axis has length 1.
ToolPose tool_of(const AxisPose& axes, const Vector3& rotary_centre_mm);

/// The tool of the same angles with the same ball (or focus): the centre of a ball of `radius_mm` at the tip does not
/// move when the axis tilts, only the tip and the machine's axes do. Radius 0 keeps the tip: a laser focus.
ToolPose tilted(const ToolPose& tool, double radius_mm, double a_rad, double c_rad);

/// What choosing branches is charged with, and between which limits.
struct BranchCosts {
  double per_a_rad = 1;
  double per_c_rad = 1;
  double per_reversal_rad = 0.5;  ///< of c: as if it had travelled this much more
  double a_min_rad = -1e9;
  double a_max_rad = 1e9;
  double c_min_rad = -1e9;
  double c_max_rad = 1e9;
  double pole_rad = 1e-9;  ///< nearer to the pole than this, c stays where it is
};

/// Axes along a whole path with the cheapest sequence of branches and turns, by dynamic programming over branch, turn
/// and sense of c (a greedy choice can pay half a turn later). Fails with out_of_range, naming the sample, where no
/// branch lies within the limits, and with bad_argument for no sample or an axis of no length.
Result<std::vector<AxisPose>> choose_branches(std::span<const ToolPose> path, const Vector3& rotary_centre_mm,
                                              const BranchCosts& costs, std::optional<double> c_start_rad = {});

}  // namespace gravure::motion
