#include "normal_system.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

namespace gravure::registration {

Similarity SmallMotion::similarity() const {
  const Eigen::Vector3d turn = by.head<3>() / length_mm;
  const double angle = turn.norm();
  Similarity motion;
  if (angle > 0) {
    motion.rotation = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  }
  motion.scale = std::exp(by[6] / length_mm);
  motion.translation_mm = centre + by.segment<3>(3) - motion.scale * (motion.rotation * centre);
  return motion;
}

void NormalSystem::add(const Eigen::Vector3d& place, const Eigen::Vector3d& normal, double distance) {
  const Eigen::Vector3d arm = (place - centre_) / length_mm_;
  Unknowns row;
  row << arm.cross(normal), normal, normal.dot(arm);
  sum_.noalias() += row * row.transpose();
  right_ -= distance * row;
  squares_ += distance * distance;
  ++count_;
}

double NormalSystem::rms() const noexcept {
  return count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0;
}

Eigen::MatrixXd NormalSystem::matrix(int unknowns) const {
  return sum_.topLeftCorner(unknowns, unknowns) / static_cast<double>(count_);
}

SmallMotion NormalSystem::step(int unknowns, double weak_share, double log_scale, double scale_deviation) const {
  SmallMotion motion{centre_, length_mm_};
  if (count_ == 0) {
    return motion;
  }
  Eigen::MatrixXd matrix = this->matrix(unknowns);
  Eigen::VectorXd right = right_.head(unknowns) / static_cast<double>(count_);
  if (unknowns == kAllUnknowns) {
    const double trust = std::pow(rms() / (scale_deviation * length_mm_), 2) / static_cast<double>(count_);
    matrix(6, 6) += trust;
    right[6] -= trust * log_scale * length_mm_;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  const double least = weak_share * solver.eigenvalues()[unknowns - 1];
  for (int i = 0; i < unknowns; ++i) {
    if (solver.eigenvalues()[i] > least) {
      const Eigen::VectorXd along = solver.eigenvectors().col(i);
      motion.by.head(unknowns) += along * (along.dot(right) / solver.eigenvalues()[i]);
    }
  }
  return motion;
}

int NormalSystem::weak_directions(int unknowns, double weak_share) const {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix(unknowns), Eigen::EigenvaluesOnly);
  const double least = weak_share * solver.eigenvalues()[unknowns - 1];
  return static_cast<int>((solver.eigenvalues().array() <= least).count());
}

Eigen::MatrixXd NormalSystem::weak_motions(double weak_share) const {
  if (count_ == 0) {
    return Eigen::MatrixXd(kRigidUnknowns, 0);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix(kRigidUnknowns));
  const double least = weak_share * solver.eigenvalues()[kRigidUnknowns - 1];
  return solver.eigenvectors().leftCols((solver.eigenvalues().array() <= least).count());
}

bool NormalSystem::holds_scale(double weak_share) const {
  constexpr double kRounding = 1e-12;  // of the largest eigenvalue: below, there is nothing to share
  const Eigen::MatrixXd all = matrix(kAllUnknowns);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> rigid(
      Eigen::MatrixXd(all.topLeftCorner<kRigidUnknowns, kRigidUnknowns>()));
  const double largest = rigid.eigenvalues()[kRigidUnknowns - 1];
  const Eigen::VectorXd coupled = all.topRightCorner<kRigidUnknowns, 1>();
  double left = all(6, 6);
  double weakly_shared = 0;
  for (int i = 0; i < kRigidUnknowns; ++i) {
    const double value = rigid.eigenvalues()[i];
    if (value > kRounding * largest) {
      const double part = rigid.eigenvectors().col(i).dot(coupled);
      const double shared = part * part / value;
      value > weak_share* largest ? left -= shared : weakly_shared += shared;
    }
  }
  return left >= weak_share * largest && weakly_shared < left / 2;
}

}  // namespace gravure::registration
