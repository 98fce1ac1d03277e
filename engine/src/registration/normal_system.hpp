#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "gravure/registration/similarity.hpp"

namespace gravure::registration {

inline constexpr int kRigidUnknowns = 6;
inline constexpr int kAllUnknowns = 7;
using NormalMatrix = Eigen::Matrix<double, kAllUnknowns, kAllUnknowns>;
using Unknowns = Eigen::Matrix<double, kAllUnknowns, 1>;

/// A small motion about `centre`: turn times length, shift, logarithm of scale times length, all in mm.
struct SmallMotion {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double length_mm = 1;
  Unknowns by = Unknowns::Zero();

  Similarity similarity() const;
};

/// What is linear in the unknowns: the distances along `normal` of places from their planes. Least squares by Gauss and
/// Newton, in directions that the distances hold.
class NormalSystem {
 public:
  NormalSystem(const Eigen::Vector3d& centre, double length_mm) : centre_(centre), length_mm_(length_mm) {}

  /// `place` on the surface where the distance is taken, so that what slides along itself moves nothing.
  void add(const Eigen::Vector3d& place, const Eigen::Vector3d& normal, double distance);
  std::int64_t count() const noexcept { return count_; }
  double rms() const noexcept;

  /// Per distance, so that it does not depend on their number; of the first `unknowns`.
  Eigen::MatrixXd matrix(int unknowns) const;
  /// The step that makes the sum of squares least, none along eigenvectors below `weak_share` of the largest
  /// eigenvalue. `log_scale` is pulled to 0 as a value known to `scale_deviation` would.
  SmallMotion step(int unknowns, double weak_share, double log_scale, double scale_deviation) const;
  int weak_directions(int unknowns, double weak_share) const;
  /// Columns: unit vectors of turns and shifts below `weak_share` of the largest eigenvalue of the rigid motion.
  Eigen::MatrixXd weak_motions(double weak_share) const;
  /// Is scale held while the rigid motion is free? Not where less than `weak_share` of the largest eigenvalue is left
  /// to it, nor where a weak direction, which step() leaves where it is, would explain most of it: scale would then be
  /// wrong by what that direction is off.
  bool holds_scale(double weak_share) const;

 private:
  Eigen::Vector3d centre_;
  double length_mm_;
  NormalMatrix sum_ = NormalMatrix::Zero();
  Unknowns right_ = Unknowns::Zero();
  double squares_ = 0;
  std::int64_t count_ = 0;
};

}  // namespace gravure::registration
