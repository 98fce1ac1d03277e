#include "gravure/kinematics/inverse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solve.hpp"

namespace gravure::kinematics {
namespace {

constexpr double kTurn = 6.28318530717958647692;

Result<Problem> check_request(const Machine& machine, const Target& target, const InverseRequest& request) {
  Problem problem{machine, target.position_mm, target.towards_head, request.field, request.near, {},
                  {},      request.branch};
  if (problem.near.empty()) {
    problem.near.assign(machine.joints.size(), 0.0);
  }
  if (problem.near.size() != machine.joints.size()) {
    return Error{ErrorCode::bad_argument, fmt::format("kinematics: near has {} positions: the machine has {} joints",
                                                      problem.near.size(), machine.joints.size())};
  }
  if (!target.position_mm.allFinite()) {
    return Error{ErrorCode::bad_argument, "kinematics: the target's position must be finite"};
  }
  if (target.towards_head) {
    const double length = target.towards_head->norm();
    if (!(length > 0) || !std::isfinite(length)) {
      return Error{ErrorCode::bad_argument,
                   fmt::format("kinematics: the target's direction has length {}: it must be above 0", length)};
    }
    problem.towards_head = *target.towards_head / length;
  }
  for (const std::size_t i : request.held) {
    if (i >= machine.joints.size()) {
      return Error{ErrorCode::bad_argument,
                   fmt::format("kinematics: held joint {}: the machine has {} joints", i, machine.joints.size())};
    }
  }
  for (std::size_t i = 0; i < machine.joints.size(); ++i) {
    if (std::find(request.held.begin(), request.held.end(), i) == request.held.end()) {
      (machine.joints[i].kind == JointKind::prismatic ? problem.prismatic : problem.revolute).push_back(i);
    }
  }
  return problem;
}

Result<Pose> solve(const Problem& problem) {
  switch (choose_solver(problem)) {
    case Solver::linear:
      return solve_linear(problem);
    case Solver::cylinder:
      return solve_cylinder(problem);
    case Solver::tilt_turn:
      return solve_tilt_turn(problem);
    case Solver::numeric:
      break;
  }
  return solve_numeric(problem);
}

void choose_turns(const Problem& problem, Pose& pose) {
  for (const std::size_t i : problem.revolute) {
    const bool is_tilt = pose.solver == Solver::tilt_turn && i == problem.revolute[0];
    if (!is_tilt && pose.solver != Solver::numeric) {
      pose.joints[i] = allowed_turn(pose.joints[i], problem.near[i], problem.machine.joints[i].limits);
    }
  }
}

Result<void> check_reached(const Problem& problem, const Pose& pose) {
  const Spot spot = forward(problem.machine, pose.joints, pose.field);
  const double missed_mm = (spot.position_mm - problem.position_mm).norm();
  const double missed_rad = problem.towards_head ? (spot.towards_head - *problem.towards_head).norm() : 0;
  if (missed_mm <= kReached * (1 + problem.position_mm.norm()) && missed_rad <= kReached) {
    return {};
  }
  return Error{
      ErrorCode::out_of_range,
      fmt::format("kinematics: the target is out of reach: the nearest pose found ({}) misses it by {:.6g} mm and "
                  "{:.6g} rad; free more joints or start nearer to it",
                  solver_name(pose.solver), missed_mm, missed_rad)};
}

}  // namespace

std::string_view solver_name(Solver solver) noexcept {
  switch (solver) {
    case Solver::linear:
      return "linear";
    case Solver::cylinder:
      return "cylinder";
    case Solver::tilt_turn:
      return "tilt_turn";
    case Solver::numeric:
      break;
  }
  return "numeric";
}

double nearest_turn(double angle_rad, double near_rad) noexcept {
  return angle_rad + kTurn * std::floor((near_rad - angle_rad) / kTurn + 0.5);
}

double allowed_turn(double angle_rad, double near_rad, const JointLimits& limits) noexcept {
  double angle = nearest_turn(angle_rad, near_rad);
  if (limits.most && angle > *limits.most) {
    angle -= kTurn * std::ceil((angle - *limits.most) / kTurn);
  }
  if (limits.least && angle < *limits.least) {
    angle += kTurn * std::ceil((*limits.least - angle) / kTurn);
  }
  return angle;
}

Result<Pose> inverse(const Machine& machine, const Target& target, const InverseRequest& request) {
  GRAVURE_TRY(const Problem problem, check_request(machine, target, request));
  GRAVURE_TRY(Pose pose, solve(problem));
  choose_turns(problem, pose);
  GRAVURE_CHECK(check_reached(problem, pose));
  GRAVURE_CHECK(check_positions(machine, pose.joints));
  return pose;
}

}  // namespace gravure::kinematics
