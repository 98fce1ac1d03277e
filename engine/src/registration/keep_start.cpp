#include "keep_start.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "polish.hpp"

namespace gravure::registration {
namespace {

using Twist = Eigen::Matrix<double, kRigidUnknowns, 1>;  ///< turn times length, shift of the centre, mm

/// The rigid motion that goes on as it begins: twists that leave a surface where it is, do so over any way.
Similarity screw(const Twist& twist, const Eigen::Vector3d& centre, double length_mm) {
  const Eigen::Vector3d turn = twist.head<3>() / length_mm;
  const Eigen::Vector3d shift = twist.tail<3>();
  const double angle = turn.norm();
  Similarity motion;
  Eigen::Vector3d way = shift;
  if (angle > 0) {
    const Eigen::Vector3d axis = turn / angle;
    motion.rotation = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const double half = std::sin(angle / 2);
    way = std::sin(angle) / angle * shift + 2 * half * half / angle * axis.cross(shift) +
          (1 - std::sin(angle) / angle) * axis.dot(shift) * axis;
  }
  motion.translation_mm = centre + way - motion.rotation * centre;
  return motion;
}

/// From `pose` to `start`, seen at the centre of the CAD.
Twist way_back(const CadSurface& cad, const Similarity& pose, const Similarity& start) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(start.rotation * pose.rotation.transpose()));
  Twist twist;
  twist << cad.radius_mm * turn.angle() * turn.axis(), start.point(pose.inverse().point(cad.centre)) - cad.centre;
  return twist;
}

bool fits_as_well(const IcpState& again, const IcpState& before) {
  constexpr double kMoreRms = 1.1;
  constexpr double kMorePairs = 0.98;
  return (again.converged || !before.converged) && again.system.rms() <= kMoreRms * before.system.rms() &&
         static_cast<double>(again.system.count()) >= kMorePairs * static_cast<double>(before.system.count());
}

}  // namespace

Similarity with_start_kept(const NormalSystem& system, double weak_share, const CadSurface& cad, const Similarity& pose,
                           const Similarity& start) {
  constexpr int kMostSteps = 50;
  constexpr double kLeastStep = 1e-10;  // of the radius
  const Eigen::MatrixXd weak = system.weak_motions(weak_share);
  Similarity kept = pose;
  for (int i = 0; i < kMostSteps && weak.cols() > 0; ++i) {
    const Twist step = weak * (weak.transpose() * way_back(cad, kept, start));
    kept = composed(screw(step, cad.centre, cad.radius_mm), kept);
    if (step.norm() < kLeastStep * cad.radius_mm) {
      break;
    }
  }
  return kept;
}

bool keep_start(const CadSurface& cad, const ScanPoints& scan, const Similarity& start, const IcpSettings& settings,
                IcpState& state, std::vector<double>& residuals) {
  constexpr int kMostRounds = 4;
  constexpr double kSettled = 1e-5;  // of the radius
  if (state.system.weak_motions(settings.weak_share).cols() == 0) {
    return true;
  }
  IcpState again = state;
  std::vector<double> distances = residuals;
  for (int round = 0; round < kMostRounds; ++round) {
    const Similarity before = again.pose;
    again.pose = with_start_kept(again.system, settings.weak_share, cad, before, start);
    if (way_back(cad, before, again.pose).norm() < kSettled * cad.radius_mm) {
      break;
    }
    again.converged = state.converged;
    again = polish(cad, scan, again, settings, &distances);
  }
  if (!fits_as_well(again, state)) {
    return false;
  }
  state = std::move(again);
  residuals = std::move(distances);
  return true;
}

}  // namespace gravure::registration
