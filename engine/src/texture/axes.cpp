#include "gravure/texture/axes.hpp"

#include <fmt/format.h>

namespace gravure::texture {

Result<std::vector<SevenAxes>> seven_axes(const kinematics::Machine& machine, std::span<const SurfacePoint> targets,
                                          std::span<const SurfacePoint> stages, kinematics::Branch branch) {
  std::vector<SevenAxes> axes;
  axes.reserve(targets.size());
  kinematics::InverseRequest request;
  request.branch = branch;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const auto at_point = [i, &stages](Error error) {
      const Vector3& p = stages[i].position_mm;
      error.message = fmt::format("point {} (stages at x = {} mm, y = {} mm, z = {} mm): {}", i, p.x(), p.y(), p.z(),
                                  error.message);
      return error;
    };
    auto pose = kinematics::inverse(machine, {stages[i].position_mm, stages[i].normal}, request);
    if (!pose) {
      return at_point(pose.error());
    }
    request.near = std::move(pose.value().joints);
    const auto field = kinematics::field_of(machine, request.near, targets[i].position_mm);
    if (!field) {
      return at_point(field.error());
    }
    axes.push_back({request.near[0], request.near[1], request.near[2], request.near[3], request.near[4],
                    field.value().u_mm, field.value().v_mm, field.value().w_mm});
  }
  return axes;
}

}  // namespace gravure::texture
