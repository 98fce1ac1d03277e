#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "solve.hpp"

namespace gravure::kinematics {
namespace {

constexpr int kMostDampedSteps = 500;
constexpr double kLeverMm = 100;      ///< weighs directions against positions: 1 rad counts as much as so many mm
constexpr double kConverged = 1e-12;  ///< mm, and as much per mm of distance

/// The unknowns and how far the spot is from the target with them.
class Search {
 public:
  explicit Search(const Problem& problem)
      : problem_(problem), pose_{problem.near, problem.field, Solver::numeric, false} {
    for (const auto* list : {&problem.prismatic, &problem.revolute}) {
      unknowns_.insert(unknowns_.end(), list->begin(), list->end());
    }
    std::sort(unknowns_.begin(), unknowns_.end());
    const std::size_t conditions = problem.towards_head ? 5 : 3;
    if (unknowns_.size() < conditions) {
      unknowns_.push_back(static_cast<Eigen::Index>(problem.near.size()) + 2);  // w
    }
    weights_.setOnes(static_cast<Eigen::Index>(unknowns_.size()));
    for (std::size_t k = 0; k < unknowns_.size(); ++k) {
      const auto i = static_cast<std::size_t>(unknowns_[k]);
      if (i < problem.near.size() && problem.machine.joints[i].kind == JointKind::revolute) {
        weights_[static_cast<Eigen::Index>(k)] = kLeverMm * kLeverMm;
      }
    }
  }

  Eigen::VectorXd error_at(const Pose& pose) const {
    const Spot spot = forward(problem_.machine, pose.joints, pose.field);
    Eigen::VectorXd error(problem_.towards_head ? 6 : 3);
    error.head<3>() = problem_.position_mm - spot.position_mm;
    if (problem_.towards_head) {
      error.tail<3>() = kLeverMm * (*problem_.towards_head - spot.towards_head);
    }
    return error;
  }

  Eigen::MatrixXd slope_at(const Pose& pose) const {
    const Jacobian jacobian = kinematics::jacobian(problem_.machine, pose.joints, pose.field);
    Eigen::MatrixXd slope(problem_.towards_head ? 6 : 3, static_cast<Eigen::Index>(unknowns_.size()));
    slope.topRows<3>() = jacobian.position(Eigen::all, unknowns_);
    if (problem_.towards_head) {
      slope.bottomRows<3>() = kLeverMm * jacobian.towards_head(Eigen::all, unknowns_);
    }
    return slope;
  }

  Pose moved(const Pose& pose, const Eigen::VectorXd& change) const {
    Pose result = pose;
    for (Eigen::Index k = 0; k < change.size(); ++k) {
      const auto i = static_cast<std::size_t>(unknowns_[static_cast<std::size_t>(k)]);
      (i < result.joints.size() ? result.joints[i] : result.field.w_mm) += change[k];
    }
    return result;
  }

  /// Levenberg and Marquardt: short steps down the slope far from the solution, Newton's steps near it.
  Pose run() {
    Pose pose = pose_;
    Eigen::VectorXd error = error_at(pose);
    const double enough = kConverged * (1 + problem_.position_mm.norm());
    double damping = 1e-3;
    for (int step = 0; step < kMostDampedSteps && error.norm() > enough && damping < 1e12; ++step) {
      const Eigen::MatrixXd slope = slope_at(pose);
      Eigen::MatrixXd normal = slope.transpose() * slope;
      normal.diagonal() += damping * weights_;
      const Pose next = moved(pose, normal.ldlt().solve(slope.transpose() * error));
      const Eigen::VectorXd next_error = error_at(next);
      if (next_error.norm() < error.norm()) {
        pose = next;
        error = next_error;
        damping = std::max(damping * 0.1, 1e-15);
      } else {
        damping *= 10;
      }
    }
    return pose;
  }

 private:
  const Problem& problem_;
  Pose pose_;
  std::vector<Eigen::Index> unknowns_;
  Eigen::VectorXd weights_;
};

}  // namespace

Result<Pose> solve_numeric(const Problem& problem) {
  if (problem.prismatic.empty() && problem.revolute.empty()) {
    return Error{ErrorCode::bad_argument, "kinematics: no joint is free to move; hold fewer of them"};
  }
  return Search(problem).run();
}

}  // namespace gravure::kinematics
