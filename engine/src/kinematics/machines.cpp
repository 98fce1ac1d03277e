#include "gravure/kinematics/machines.hpp"

namespace gravure::kinematics {
namespace {

Joint prismatic(const char* name, Side side, const Vector3& axis) {
  return {name, JointKind::prismatic, side, axis, Vector3::Zero(), {}};
}

Joint revolute(const char* name, const Vector3& axis, const Vector3& origin_mm) {
  return {name, JointKind::revolute, Side::workpiece, axis, origin_mm, {}};
}

ScanHead placed(const ScanHead& head, const Vector3& origin_mm, const Vector3& v_axis) {
  ScanHead result = head;
  result.origin_mm = origin_mm;
  result.u_axis = Vector3::UnitX();
  result.v_axis = v_axis;
  result.beam_axis = Vector3::UnitZ();
  return result;
}

}  // namespace

Machine cylinder_machine(double focus_mm, const ScanHead& head) {
  return {"turning workpiece",
          {revolute("c", Vector3::UnitX(), Vector3::Zero()), prismatic("x", Side::tool, Vector3::UnitX()),
           prismatic("z", Side::tool, Vector3::UnitZ())},
          placed(head, {0, 0, focus_mm}, Vector3::UnitY())};
}

Machine plane_machine(const ScanHead& head) {
  return {"flat panel",
          {prismatic("x", Side::tool, Vector3::UnitX()), prismatic("y", Side::workpiece, -Vector3::UnitY()),
           prismatic("z", Side::tool, Vector3::UnitZ())},
          placed(head, Vector3::Zero(), Vector3::UnitY())};
}

Machine xyzac_machine(XyzacSigns signs, const Vector3& rotary_centre_mm, const ScanHead& head) {
  const double sense = signs == XyzacSigns::texturing ? -1 : 1;
  const Vector3 y_axis = sense * Vector3::UnitY();
  return {"X-Y-Z-A-C",
          {prismatic("X", Side::tool, Vector3::UnitX()), prismatic("Y", Side::tool, y_axis),
           prismatic("Z", Side::tool, Vector3::UnitZ()), revolute("A", sense * Vector3::UnitX(), rotary_centre_mm),
           revolute("C", sense * Vector3::UnitZ(), rotary_centre_mm)},
          placed(head, rotary_centre_mm, y_axis)};
}

}  // namespace gravure::kinematics
