#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "chain.hpp"
#include "solve.hpp"

namespace gravure::kinematics {
namespace {

constexpr double kParallel =
    1e-12;                       ///< sine of the angle between directions that count as parallel (or at right angles)
constexpr double kPole = 1e-12;  ///< nearer to an axis than this (as a share of the length), its angle is open

/// The free joints at 0, the held ones where they are.
JointPositions baseline(const Problem& problem) {
  JointPositions joints = problem.near;
  for (const auto* list : {&problem.prismatic, &problem.revolute}) {
    for (const std::size_t i : *list) {
      joints[i] = 0;
    }
  }
  return joints;
}

/// From `from` to `to` about `axis`, both at right angles to it.
double angle_about(const Vector3& axis, const Vector3& from, const Vector3& to) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to));
}

Vector3 across(const Vector3& axis, const Vector3& vector) {
  return vector - axis.dot(vector) * axis;
}

/// Is `joint` carried by `carrier`?
bool is_carried(const Machine& machine, std::size_t joint, std::size_t carrier) {
  return joint > carrier && machine.joints[joint].side == machine.joints[carrier].side;
}

/// How the spot moves in the machine's frame against the workpiece when a free prismatic joint of a cylinder moves.
Vector3 shift_of(const Problem& problem, const std::vector<Screw>& screws, std::size_t joint) {
  return problem.machine.joints[joint].side == Side::tool ? screws[joint].axis : Vector3(-screws[joint].axis);
}

/// The free prismatic joints of a cylindrical machine by their part; the joint that moves the head towards the axis may
/// be missing.
struct CylinderParts {
  std::optional<std::size_t> along;
  std::optional<std::size_t> towards;
};

CylinderParts cylinder_parts(const Problem& problem, const std::vector<Screw>& screws) {
  const Vector3& axis = screws[problem.revolute[0]].axis;
  CylinderParts parts;
  for (const std::size_t i : problem.prismatic) {
    (across(axis, screws[i].axis).norm() < kParallel ? parts.along : parts.towards) = i;
  }
  return parts;
}

bool is_cylinder(const Problem& problem) {
  if (problem.revolute.size() != 1 || problem.prismatic.empty() || problem.prismatic.size() > 2 ||
      problem.machine.joints[problem.revolute[0]].side != Side::workpiece) {
    return false;
  }
  const std::vector<Screw> screws = screws_at(problem.machine, baseline(problem));
  const bool is_outside = std::none_of(problem.prismatic.begin(), problem.prismatic.end(), [&](std::size_t i) {
    return is_carried(problem.machine, i, problem.revolute[0]);
  });
  const CylinderParts parts = cylinder_parts(problem, screws);
  return is_outside && parts.along && (parts.towards.has_value() == (problem.prismatic.size() == 2));
}

bool is_tilt_turn(const Problem& problem) {
  if (!problem.towards_head || problem.revolute.size() != 2 || problem.prismatic.size() < 2 ||
      problem.prismatic.size() > 3) {
    return false;
  }
  const std::vector<Screw> screws = screws_at(problem.machine, baseline(problem));
  const auto is_under_workpiece = [&](std::size_t i) { return problem.machine.joints[i].side == Side::workpiece; };
  return is_under_workpiece(problem.revolute[0]) && is_under_workpiece(problem.revolute[1]) &&
         std::abs(screws[problem.revolute[0]].axis.dot(screws[problem.revolute[1]].axis)) < kParallel;
}

/// With the rotary joints where they are the spot is linear in the rest: the prismatic joints, and w where fewer than
/// three of them are free. One step is exact but for rounding, the second removes that.
Result<void> place_prismatic(const Problem& problem, Pose& pose) {
  const auto joints = static_cast<Eigen::Index>(pose.joints.size());
  std::vector<Eigen::Index> unknowns(problem.prismatic.begin(), problem.prismatic.end());
  const std::size_t needed = pose.solver == Solver::cylinder ? 2 : 3;  // the cylinder's angle has settled one
  if (unknowns.size() < needed) {
    unknowns.push_back(joints + 2);
    pose.field.w_mm = 0;
  }
  for (int step = 0; step < 2; ++step) {
    const Jacobian jacobian = kinematics::jacobian(problem.machine, pose.joints, pose.field);
    const Eigen::Matrix<double, 3, Eigen::Dynamic> columns = jacobian.position(Eigen::all, unknowns);
    const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 3, Eigen::Dynamic>> solver(columns);
    if (solver.rank() < columns.cols()) {
      return Error{ErrorCode::out_of_range,
                   "kinematics: the free joints move the spot along fewer directions than needed at this pose; hold "
                   "one of them or start from another pose"};
    }
    const Vector3 missing = problem.position_mm - forward(problem.machine, pose.joints, pose.field).position_mm;
    const Eigen::VectorXd change = solver.solve(missing);
    for (Eigen::Index k = 0; k < change.size(); ++k) {
      const Eigen::Index unknown = unknowns[static_cast<std::size_t>(k)];
      (unknown < joints ? pose.joints[static_cast<std::size_t>(unknown)] : pose.field.w_mm) += change[k];
    }
  }
  return {};
}

}  // namespace

Solver choose_solver(const Problem& problem) {
  if (problem.revolute.empty() && (problem.prismatic.size() == 2 || problem.prismatic.size() == 3)) {
    return Solver::linear;
  }
  if (is_cylinder(problem)) {
    return Solver::cylinder;
  }
  return is_tilt_turn(problem) ? Solver::tilt_turn : Solver::numeric;
}

Result<Pose> solve_linear(const Problem& problem) {
  Pose pose{baseline(problem), problem.field, Solver::linear, false};
  GRAVURE_CHECK(place_prismatic(problem, pose));
  return pose;
}

/// Seen along the axis, the point runs round a circle and must come to lie on the beam (or on the line that the lifting
/// joint moves the spot along): circle meets line, on the side towards the head or away from it.
Result<Pose> solve_cylinder(const Problem& problem) {
  Pose pose{baseline(problem), problem.field, Solver::cylinder, false};
  const std::size_t c = problem.revolute[0];
  const Machine& machine = problem.machine;
  const std::vector<Screw> screws = screws_at(machine, pose.joints);
  const CylinderParts parts = cylinder_parts(problem, screws);
  if (!parts.towards) {
    pose.field.w_mm = 0;
  }
  const Frames frames = frames_at(machine, pose.joints);
  const Vector3& axis = screws[c].axis;
  const Vector3 point = across(axis, frames.workpiece * problem.position_mm - screws[c].point_mm);

  const Spot spot = forward(machine, pose.joints, pose.field);
  const Vector3 on_line = across(axis, frames.workpiece * spot.position_mm - screws[c].point_mm);
  const Vector3 beam = frames.workpiece.linear() * spot.towards_head;
  const Vector3 line = across(axis, parts.towards ? shift_of(problem, screws, *parts.towards) : beam);
  if (line.norm() < kParallel) {
    return solve_numeric(problem);
  }
  const Vector3 up = (line.dot(beam) < 0 ? -1.0 : 1.0) * line.normalized();
  const Vector3 side = axis.cross(up);
  const double radius = point.norm();
  const double distance = side.dot(on_line);
  if (std::abs(distance) > radius + kReached) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("kinematics: the beam passes joint {}'s axis at {:.6g} mm and never meets a point only {:.6g} mm "
                    "from it; move V towards 0",
                    machine.joints[c].name, std::abs(distance), radius)};
  }
  pose.is_singular = radius <= kPole;
  if (pose.is_singular) {
    pose.joints[c] = problem.near[c];
  } else {
    const double height = std::sqrt(std::max(0.0, (radius - distance) * (radius + distance)));
    const Vector3 wanted = distance * side + (problem.branch == Branch::positive ? height : -height) * up;
    pose.joints[c] = angle_about(axis, point, wanted);
  }
  GRAVURE_CHECK(place_prismatic(problem, pose));
  return pose;
}

/// R(outer) R(inner) d = b: both sides keep their part along their own axis, so the vector between the two turns is
/// known but for a sign.
Result<Pose> solve_tilt_turn(const Problem& problem) {
  Pose pose{baseline(problem), problem.field, Solver::tilt_turn, false};
  const std::vector<Screw> screws = screws_at(problem.machine, pose.joints);
  const Frames frames = frames_at(problem.machine, pose.joints);
  const std::size_t outer = problem.revolute[0];
  const std::size_t inner = problem.revolute[1];
  const Vector3& tilt_axis = screws[outer].axis;
  const Vector3& turn_axis = screws[inner].axis;
  const Vector3 third = tilt_axis.cross(turn_axis);
  const Vector3 direction = frames.workpiece.linear() * *problem.towards_head;
  const Vector3 beam = frames.workpiece.linear() * forward(problem.machine, pose.joints, pose.field).towards_head;

  const Vector3 flat = across(turn_axis, direction);
  const double along_tilt = tilt_axis.dot(beam);
  const double reach = flat.norm();
  if (std::abs(along_tilt) > reach + kReached) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format(
            "kinematics: joints {} and {} cannot turn this direction into the beam at U = {:.6g}, V = {:.6g} mm; "
            "move U and V towards 0",
            problem.machine.joints[outer].name, problem.machine.joints[inner].name, problem.field.u_mm,
            problem.field.v_mm)};
  }
  // A difference of squares as a product: exact near the pole.
  const double rest = std::sqrt(std::max(0.0, (reach - std::abs(along_tilt)) * (reach + std::abs(along_tilt))));
  pose.is_singular = reach <= kPole;
  // The vector between the turns stands to one side or the other of the plane of both axes: the two branches.
  const bool is_minus = (problem.branch == Branch::positive) == (turn_axis.dot(beam) > 0);
  const Vector3 between = along_tilt * tilt_axis + (is_minus ? -rest : rest) * third;
  pose.joints[inner] = pose.is_singular ? problem.near[inner] : angle_about(turn_axis, flat, between);
  const Vector3 turned = Eigen::AngleAxisd(pose.joints[inner], turn_axis) * direction;
  pose.joints[outer] = angle_about(tilt_axis, across(tilt_axis, turned), across(tilt_axis, beam));
  GRAVURE_CHECK(place_prismatic(problem, pose));
  return pose;
}

}  // namespace gravure::kinematics
