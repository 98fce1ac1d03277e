#include "gravure/scan/joint_reach.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gravure/core/exposure_map.hpp"
#include "gravure/scan/plan_trajectory.hpp"

namespace gravure::scan {
namespace {

using kinematics::Joint;
using kinematics::JointKind;
using kinematics::Machine;
using kinematics::Side;
using kinematics::Vector3;

constexpr double kDegPerRad = 180 / 3.14159265358979323846;
constexpr double kParallel = 1 - 1e-9;  // cosine of the angle between directions that count as parallel

struct Range {
  double from = 0;
  double to = 0;

  Range operator+(double shift) const noexcept { return {from + shift, to + shift}; }
};

/// How far an axis moves before and after the marking.
Range with_ramps(Range range, const std::optional<AxisSpin>& spin) {
  return spin ? Range{range.from - to_double(spin->up.travel), range.to + to_double(spin->down.travel)} : range;
}

/// The share of a line that has passed when the head stands at the middle of the forward window.
double share_at_centre(const LinePlan& line) {
  return (static_cast<double>(line.forward_first_slot) + static_cast<double>(line.pixels - 1) / 2) /
         static_cast<double>(line.slots);
}

/// Where the head's centre is over the image, along its lines, in mm.
Range along_lines(const Plan& plan) {
  const double pitch_mm = to_double(plan.line.pixel_pitch_um) / 1000;
  const double centre_mm = static_cast<double>(plan.line.pixels - 1) / 2 * pitch_mm;
  if (plan.carriage) {
    const double feed_mm = to_double(plan.carriage->feed_um) / 1000;
    const HelicalWindow first = helical_window(plan, 0, 0);
    const double start_mm =
        to_double(Rational(first.first_column) + first.fraction) * pitch_mm + centre_mm -
        feed_mm / static_cast<double>(plan.rotary.lines_per_revolution) * share_at_centre(plan.line);
    return with_ramps({start_mm, start_mm + feed_mm * static_cast<double>(plan.job.revolutions)}, plan.carriage->spin);
  }
  const double bands_mm = plan.bands ? to_double(plan.bands->step_mm) * static_cast<double>(plan.bands->count - 1) : 0;
  return {centre_mm, centre_mm + bands_mm};
}

/// Flat: which line of the image is under the head's centre, in mm. Passes back begin and end with the same ramps.
Range across_lines(const Plan& plan) {
  const double pitch_mm = to_double(plan.rotary.line_pitch_um) / 1000;
  const double before_mm = pitch_mm * share_at_centre(plan.line);
  const double after_mm = pitch_mm - before_mm;
  const double length_mm = pitch_mm * static_cast<double>(plan.rotary.lines_per_revolution - 1);
  const Range there = with_ramps({-before_mm, length_mm + after_mm}, plan.spin);
  if (plan.job.revolutions < 2) {
    return there;
  }
  const Range back = with_ramps({-length_mm - before_mm, after_mm}, plan.spin);  // seen the other way
  return {std::min(there.from, -back.to), std::max(there.to, -back.from)};
}

/// Degrees of the workpiece, from rest; each band is a run of its own, with its ramps.
Range turning(const Plan& plan) {
  const Rational ramps_deg = plan.spin ? plan.spin->up.travel + plan.spin->down.travel : Rational(0);
  const Rational run_deg = Rational(360) * Rational(revolutions_per_band(plan)) + ramps_deg;
  return {0, to_double(Rational(run_deg * Rational(plan.bands ? plan.bands->count : 1)))};
}

/// +1 where positive motion of the joint brings the head further along the direction over the workpiece.
double sense_of(const Joint& joint, const Vector3& direction) {
  const double along = joint.axis.dot(direction) < 0 ? -1 : 1;
  const bool head = joint.side == Side::tool;
  return joint.kind == JointKind::prismatic && !head ? -along
         : joint.kind == JointKind::revolute && head ? -along
                                                     : along;
}

double in_unit(const Joint& joint, double value) {
  return joint.kind == JointKind::revolute ? value * kDegPerRad : value;
}

JointReach at_rest(const Joint& joint) {
  JointReach reach{joint.name, joint.kind, 0, 0, joint.limits.least, joint.limits.most};
  for (std::optional<double>* limit : {&reach.least_allowed, &reach.most_allowed}) {
    if (*limit) {
      *limit = in_unit(joint, **limit);
    }
  }
  return reach;
}

std::string limit_text(const std::optional<double>& limit) {
  return limit ? fmt::format("{:.9g}", *limit) : "any";
}

}  // namespace

Result<std::optional<std::size_t>> joint_along(const Machine& machine, JointKind kind, const Vector3& direction,
                                               const std::string& use) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < machine.joints.size(); ++i) {
    const Joint& joint = machine.joints[i];
    if (joint.kind != kind || std::abs(joint.axis.dot(direction)) < kParallel) {
      continue;
    }
    if (found) {
      return Error{ErrorCode::bad_argument, "joints " + machine.joints[*found].name + " and " + joint.name +
                                                " could both be the axis of " + use +
                                                "; describe in this file only the one that is"};
    }
    found = i;
  }
  return found;
}

Result<std::vector<JointReach>> joint_reach(const Machine& machine, const Plan& plan) {
  std::vector<JointReach> reach;
  for (const Joint& joint : machine.joints) {
    reach.push_back(at_rest(joint));
  }
  const auto moves = [&](const std::optional<std::size_t>& at, const Vector3& direction, const Range& range) {
    if (at) {
      const double sense = sense_of(machine.joints[*at], direction);
      reach[*at].least = std::min(sense * range.from, sense * range.to);
      reach[*at].most = std::max(sense * range.from, sense * range.to);
    }
  };
  const kinematics::ScanHead& head = machine.head;
  Vector3 surface_mm = head.origin_mm;  // what the focus is over, at column and line 0
  const bool flat = plan.mode == Mode::flat;
  if (!flat) {
    GRAVURE_TRY(const auto rotary, joint_along(machine, JointKind::revolute, head.u_axis, "[rotary]"));
    moves(rotary, head.u_axis, turning(plan));
    if (rotary) {
      GRAVURE_TRY(const LineGeometry geometry, plan_geometry(plan));
      surface_mm = machine.joints[*rotary].origin_mm + geometry.machine.head.origin_mm.z() * head.beam_axis;
    }
  }
  const Vector3 to_focus = surface_mm - head.origin_mm;
  GRAVURE_TRY(const auto along, joint_along(machine, JointKind::prismatic, head.u_axis, "the lines"));
  moves(along, head.u_axis, along_lines(plan) + -head.origin_mm.dot(head.u_axis));
  GRAVURE_TRY(const auto across, joint_along(machine, JointKind::prismatic, head.v_axis, "what goes across the lines"));
  const double v_mm = to_focus.dot(head.v_axis);
  moves(across, head.v_axis, flat ? across_lines(plan) + -head.origin_mm.dot(head.v_axis) : Range{v_mm, v_mm});
  GRAVURE_TRY(const auto lift, joint_along(machine, JointKind::prismatic, head.beam_axis, "the focus"));
  const double w_mm = to_focus.dot(head.beam_axis);
  moves(lift, head.beam_axis, {w_mm, w_mm});
  return reach;
}

Result<void> check_reach(const std::vector<JointReach>& joints) {
  std::string text;
  for (const JointReach& joint : joints) {
    if (!joint.is_within_limits()) {
      const char* unit = joint.kind == JointKind::revolute ? "deg" : "mm";
      const std::string where = joint.least == joint.most
                                    ? fmt::format("stands at {:.9g} {}", joint.least, unit)
                                    : fmt::format("goes from {:.9g} to {:.9g} {}", joint.least, joint.most, unit);
      text += fmt::format("{}joint {} {} in this job: its limits are {} to {} {}", text.empty() ? "" : "\n",
                          joint.joint, where, limit_text(joint.least_allowed), limit_text(joint.most_allowed), unit);
    }
  }
  return text.empty() ? Result<void>() : Error{ErrorCode::out_of_range, text};
}

}  // namespace gravure::scan
