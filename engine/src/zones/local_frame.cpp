#include "gravure/zones/local_frame.hpp"

#include <Eigen/Geometry>

namespace gravure::zones {

Vector3 LocalFrame::to_local(const Vector3& part_mm) const noexcept {
  const Vector3 offset = part_mm - origin_mm;
  return {x.dot(offset), y.dot(offset), z.dot(offset)};
}

Vector3 LocalFrame::to_part(const Vector3& local_mm) const noexcept {
  return origin_mm + local_mm.x() * x + local_mm.y() * y + local_mm.z() * z;
}

Eigen::Matrix4d LocalFrame::matrix() const noexcept {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.block<1, 3>(0, 0) = x.transpose();
  matrix.block<1, 3>(1, 0) = y.transpose();
  matrix.block<1, 3>(2, 0) = z.transpose();
  matrix(0, 3) = -x.dot(origin_mm);
  matrix(1, 3) = -y.dot(origin_mm);
  matrix(2, 3) = -z.dot(origin_mm);
  return matrix;
}

Result<LocalFrame> local_frame(const Vector3& direction, const Vector3& origin_mm) {
  const double length = direction.norm();
  if (!(length > 0) || !direction.allFinite()) {
    return Error{ErrorCode::out_of_range, "the direction of a local frame has no length"};
  }
  LocalFrame frame;
  frame.z = direction / length;
  frame.origin_mm = origin_mm;
  // Beside the pole the horizontal part of z still says where y goes, to the last bit of the direction that was given.
  constexpr double kPole = 1e-12;
  const bool is_pole = frame.z.head<2>().norm() < kPole;
  const Vector3 up = is_pole ? Vector3::UnitY() : Vector3::UnitZ();
  frame.x = up.cross(frame.z).normalized();  // along y x z, without the cancellation of up - (up.z) z
  frame.y = frame.z.cross(frame.x);
  return frame;
}

}  // namespace gravure::zones
