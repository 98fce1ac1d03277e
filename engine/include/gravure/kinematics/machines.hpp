#pragma once

#include <cstdint>

#include "gravure/kinematics/machine.hpp"

namespace gravure::kinematics {

/// A turning workpiece for the rotary and helical modes: its axis is x, the beam comes from +z. Joints: "c" turns the
/// workpiece (a growing c brings larger angles under the beam, angles counted from z towards y), "x" carries the head
/// along the axis, "z" lifts it. The focus at U = V = c = x = z = 0 is at (0, 0, focus_mm): the radius for a line at
/// the top, radius * cos(offset) for one `offset` round the circumference. `head` gives lens, field and resolution; its
/// frame is set here.
Machine cylinder_machine(double focus_mm, const ScanHead& head);

/// A flat panel on a linear stage for the flat mode: the surface is z = 0, "x" carries the head along the lines, "y"
/// the workpiece across them (a growing y brings larger y under the beam), "z" lifts the head.
Machine plane_machine(const ScanHead& head);

/// Both publications put the workpiece on C on A; they differ in signs.
enum class XyzacSigns : std::uint8_t {
  texturing,       ///< [A] eqs 6 to 13: M = diag(1, -1, 1) Rx(-A) Rz(-C), det M = -1: Y and V count against y
  post_processor,  ///< [C2]: (X, Y, Z) = Rx(A) Rz(C) (p - L)
};

/// Joints "X", "Y", "Z" carry the head, "A" and "C" the workpiece; the A and C axes meet at `rotary_centre_mm`, where
/// X, Y and Z count from.
Machine xyzac_machine(XyzacSigns signs, const Vector3& rotary_centre_mm, const ScanHead& head);

}  // namespace gravure::kinematics
