#include "weak_directions.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <string>

namespace gravure::registration {
namespace {

constexpr double kTurns = 0.1;   // share of a unit vector of unknowns that makes it a turn, not a shift
constexpr double kScrews = 0.1;  // shift for one radian, as a share of the length, that makes a turn a screw
constexpr double kNoCondition = 1e300;

/// Rounded, the first large component positive: the same whatever the last bits of a solver are.
std::string direction_text(Eigen::Vector3d direction) {
  direction.normalize();
  for (int i = 0; i < 3; ++i) {
    if (std::abs(direction[i]) > 0.1) {
      direction *= direction[i] < 0 ? -1 : 1;
      break;
    }
  }
  const Eigen::Vector3d rounded = (direction * 1000).array().round() / 1000 + 0.0;
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", rounded[0], rounded[1], rounded[2]);
}

std::string place_text(const Eigen::Vector3d& place) {
  const Eigen::Vector3d rounded = (place * 100).array().round() / 100 + 0.0;
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", rounded[0], rounded[1], rounded[2]);
}

struct Kinds {
  int turns = 0;
  int screws = 0;
  int shifts = 0;
  int scales = 0;
};

std::string name_of(const Eigen::VectorXd& motion, const Eigen::Vector3d& centre, double length_mm, Kinds& kinds) {
  const Eigen::Vector3d turn = motion.head<3>() / length_mm;
  const Eigen::Vector3d shift = motion.segment<3>(3);
  const double scale = motion.size() == kAllUnknowns ? motion[6] : 0;
  const std::string scaled = std::abs(scale) > kTurns ? "scale with " : "";
  if (motion.head<3>().norm() > kTurns) {
    const Eigen::Vector3d through = centre + turn.cross(shift) / turn.squaredNorm();
    const double pitch_mm = turn.dot(shift) / turn.squaredNorm();
    const bool screws = std::abs(pitch_mm) > kScrews * length_mm;
    (screws ? kinds.screws : kinds.turns) += scaled.empty() ? 1 : 0;
    kinds.scales += scaled.empty() ? 0 : 1;
    return scaled + (screws ? fmt::format("screw of {:.3f} mm a radian", pitch_mm) : "turn") + " about " +
           direction_text(turn) + " through " + place_text(through);
  }
  kinds.scales += scaled.empty() ? 0 : 1;
  kinds.shifts += scaled.empty() ? 1 : 0;
  return shift.norm() > kTurns ? scaled + "shift along " + direction_text(shift) : "scale";
}

std::string shape_of(const Kinds& kinds) {
  if (kinds.scales > 0) {
    return kinds.turns + kinds.shifts + kinds.screws > 0 ? "of a size that is not held" : "";
  }
  if (kinds.turns == 1 && kinds.shifts == 2) {
    return "plane";
  }
  if (kinds.turns == 1 && kinds.shifts == 1) {
    return "cylinder";
  }
  if (kinds.turns == 3) {
    return "sphere";
  }
  if (kinds.turns == 1 && kinds.shifts == 0) {
    return "surface of revolution";
  }
  if (kinds.shifts == 1 && kinds.turns == 0) {
    return "extrusion";
  }
  return kinds.screws == 1 && kinds.turns + kinds.shifts == 0 ? "helix" : "free in several ways";
}

/// The same space, shifts and turns apart: combined so that as many as can be have no turn in them.
Eigen::MatrixXd turns_apart(const Eigen::MatrixXd& space) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(space.topRows(3), Eigen::ComputeFullV);
  return space * svd.matrixV();
}

}  // namespace

void describe_weak_directions(const NormalSystem& system, int unknowns, const Eigen::Vector3d& centre, double length_mm,
                              double weak_share, Registration& result) {
  const Eigen::MatrixXd matrix = system.matrix(unknowns);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  const Eigen::VectorXd values = solver.eigenvalues().cwiseMax(0);
  const double largest = values[unknowns - 1];
  int weak = 0;
  for (int i = 0; i < unknowns; ++i) {
    result.eigenvalues.push_back(values[i]);
    const bool held = values[i] > weak_share * largest;
    weak += held ? 0 : 1;
    result.deviations_mm.push_back(
        values[i] > 0 ? system.rms() / std::sqrt(values[i] * static_cast<double>(system.count())) : kNoCondition);
  }
  result.condition_number = values[0] > 0 ? std::min(kNoCondition, largest / values[0]) : kNoCondition;
  if (weak == 0) {
    return;
  }
  Kinds kinds;
  const Eigen::MatrixXd space = turns_apart(solver.eigenvectors().leftCols(weak));
  for (int i = 0; i < weak; ++i) {
    const Eigen::VectorXd motion = space.col(i);
    result.weak_directions.push_back(
        {name_of(motion, centre, length_mm, kinds), std::max(0.0, motion.dot(matrix * motion))});
  }
  result.shape = shape_of(kinds);
}

}  // namespace gravure::registration
