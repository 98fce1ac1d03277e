#pragma once

#include <span>
#include <vector>

#include "gravure/kinematics/inverse.hpp"
#include "gravure/kinematics/machine.hpp"
#include "gravure/texture/surface.hpp"

namespace gravure::texture {

/// Where five stages and the galvo stand for one point of a texture, [A] eqs 6 to 13, and what is left along the beam.
struct SevenAxes {
  double x_mm = 0;
  double y_mm = 0;
  double z_mm = 0;
  double a_rad = 0;
  double c_rad = 0;  ///< turns counted on along the path
  double u_mm = 0;
  double v_mm = 0;
  double w_mm = 0;  ///< the focus offset: where a focus axis stands, or what no axis takes up
};

/// The axes of an X-Y-Z-A-C machine (kinematics::xyzac_machine) along a path: the stages bring each point of `stages`
/// and its normal under the beam, the galvo reaches from there to the point of `targets`. In closed form, [A] eqs 6 to
/// 13, for both sign conventions and wherever A and C meet. C keeps its turns from point to point and stands still at
/// the pole; `branch` is the sign of A. bad_argument for machines that are not so (rotary_table()) and points that are
/// not finite, out_of_range for a joint beyond its limits, naming the point.
Result<std::vector<SevenAxes>> seven_axes(const kinematics::Machine& machine, std::span<const SurfacePoint> targets,
                                          std::span<const SurfacePoint> stages,
                                          kinematics::Branch branch = kinematics::Branch::positive);

}  // namespace gravure::texture
