#include "gravure/registration/similarity.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <string>

#include "vectors.hpp"

namespace gravure::registration {

Point3 Similarity::point(const Point3& place_mm) const {
  return point3(point(vector(place_mm)));
}

Point3 Similarity::direction(const Point3& along) const {
  return point3(direction(vector(along)));
}

Similarity Similarity::inverse() const {
  Similarity back;
  back.rotation = rotation.transpose();
  back.scale = 1 / scale;
  back.translation_mm = -back.scale * (back.rotation * translation_mm);
  return back;
}

Eigen::Matrix4d Similarity::matrix() const {
  Eigen::Matrix4d all = Eigen::Matrix4d::Identity();
  all.topLeftCorner<3, 3>() = scale * rotation;
  all.topRightCorner<3, 1>() = translation_mm;
  return all;
}

Similarity composed(const Similarity& second, const Similarity& first) {
  Similarity both;
  both.rotation = second.rotation * first.rotation;
  both.scale = second.scale * first.scale;
  both.translation_mm = second.point(first.translation_mm);
  return both;
}

Result<Similarity> similarity_of_pairs(std::span<const Point3> from, std::span<const Point3> to, bool with_scale) {
  if (from.size() != to.size() || from.size() < 3) {
    return Error{ErrorCode::bad_argument, std::to_string(from.size()) + " points and " + std::to_string(to.size()) +
                                              " partners: must be as many, 3 or more"};
  }
  const auto count = static_cast<double>(from.size());
  Eigen::Vector3d from_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    from_mean += vector(from[i]) / count;
    to_mean += vector(to[i]) / count;
  }
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  double spread = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector3d centred = vector(from[i]) - from_mean;
    cross += (vector(to[i]) - to_mean) * centred.transpose();
    spread += centred.squaredNorm();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d singular = svd.singularValues();
  if (!(singular[1] > 1e-12 * singular[0])) {
    return Error{ErrorCode::bad_argument, "the points are on one line or at one place: the pose is not determined"};
  }
  const double sign = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
  const Eigen::Vector3d signs(1, 1, sign);
  Similarity found;
  found.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  found.scale = with_scale ? singular.dot(signs) / spread : 1;
  found.translation_mm = to_mean - found.scale * (found.rotation * from_mean);
  return found;
}

}  // namespace gravure::registration
