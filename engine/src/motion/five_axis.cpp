#include "gravure/motion/five_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "vector3.hpp"

namespace gravure::motion {
namespace {

/// `angle` with the whole turns that bring it nearest to `near`.
double nearest_turn(double angle, double near) noexcept {
  return angle + 2 * std::numbers::pi * std::round((near - angle) / (2 * std::numbers::pi));
}

/// One way to stand at a sample, with the cheapest way to get there.
struct Choice {
  double a = 0;
  double c = 0;
  int sense = 0;  ///< of the last movement of c
  double cost = 0;
  std::size_t from = 0;
};

double step_cost(const Choice& from, double a, double c, const BranchCosts& costs, int& sense) noexcept {
  const double turn = c - from.c;
  sense = turn > 0 ? 1 : turn < 0 ? -1 : from.sense;
  const bool reverses = from.sense != 0 && sense != from.sense;
  return from.cost + costs.per_a_rad * std::abs(a - from.a) + costs.per_c_rad * std::abs(turn) +
         (reverses ? costs.per_reversal_rad : 0);
}

bool within(double value, double low, double high) noexcept {
  return value >= low - 1e-12 && value <= high + 1e-12;
}

/// Keeps the cheapest of the choices that stand alike.
void keep(std::vector<Choice>& choices, const Choice& choice) {
  for (Choice& other : choices) {
    if (other.sense == choice.sense && std::abs(other.a - choice.a) < 1e-12 && std::abs(other.c - choice.c) < 1e-9) {
      other = choice.cost < other.cost ? choice : other;
      return;
    }
  }
  choices.push_back(choice);
}

/// All choices at one sample that a choice before can move to: both branches, the nearest turns of each.
class Reachable {
 public:
  Reachable(const ToolPose& tool, const BranchCosts& costs) : costs_(costs) {
    flat_ = std::hypot(tool.axis[0], tool.axis[1]);
    tilt_ = std::atan2(flat_, tool.axis[2]);
    turn_ = std::atan2(tool.axis[0], tool.axis[1]);
    pole_ = flat_ <= costs.pole_rad * length_of(tool.axis);
  }

  void extend(const Choice& from, std::size_t index, std::vector<Choice>& choices) const {
    for (const double side : {1.0, -1.0}) {
      const double a = side * tilt_;
      const double base = side > 0 ? turn_ : turn_ + std::numbers::pi;
      const double nearest = pole_ ? from.c : nearest_turn(base, from.c);
      for (const double c : {nearest, nearest - 2 * std::numbers::pi, nearest + 2 * std::numbers::pi}) {
        if (within(a, costs_.a_min_rad, costs_.a_max_rad) && within(c, costs_.c_min_rad, costs_.c_max_rad)) {
          Choice choice{a, c, 0, 0, index};
          choice.cost = step_cost(from, a, c, costs_, choice.sense);
          keep(choices, choice);
        }
      }
    }
  }

  /// Without a past: every turn within the limits, next to `near`.
  void begin(double near, bool charged, std::vector<Choice>& choices) const {
    const Choice nowhere{0, near, 0, 0, 0};
    extend(nowhere, 0, choices);
    for (Choice& choice : choices) {
      choice.sense = 0;
      choice.cost = charged ? costs_.per_c_rad * std::abs(choice.c - near) : 0;
    }
  }

 private:
  BranchCosts costs_;
  double flat_ = 0;
  double tilt_ = 0;
  double turn_ = 0;
  bool pole_ = false;
};

/// More than this many ways to stand at one sample are never needed: turns further off cost whole turns.
constexpr std::size_t kMostChoices = 64;

void prune(std::vector<Choice>& choices) {
  if (choices.size() > kMostChoices) {
    std::stable_sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) { return a.cost < b.cost; });
    choices.resize(kMostChoices);
  }
}

Error no_branch(std::size_t sample, const BranchCosts& costs) {
  return Error{
      ErrorCode::out_of_range,
      fmt::format("five_axis: sample {}: no branch lies within a {} to {} and c {} to {} rad; tilt the workpiece or "
                  "widen the limits",
                  sample + 1, costs.a_min_rad, costs.a_max_rad, costs.c_min_rad, costs.c_max_rad)};
}

}  // namespace

AxisPose axes_at(const Vector3& centre_mm, const Vector3& rotary_centre_mm, double a_rad, double c_rad) noexcept {
  const double x = centre_mm[0] - rotary_centre_mm[0];
  const double y = centre_mm[1] - rotary_centre_mm[1];
  const double z = centre_mm[2] - rotary_centre_mm[2];
  const double xr = std::cos(c_rad) * x - std::sin(c_rad) * y;
  const double yr = std::sin(c_rad) * x + std::cos(c_rad) * y;
  return {xr, std::cos(a_rad) * yr - std::sin(a_rad) * z, std::sin(a_rad) * yr + std::cos(a_rad) * z, a_rad, c_rad};
}

AxisPose axes_of(const ToolPose& tool, const Vector3& rotary_centre_mm, Branch branch, double c_before_rad) {
  const double flat = std::hypot(tool.axis[0], tool.axis[1]);
  const double tilt = std::atan2(flat, tool.axis[2]);
  const double turn = std::atan2(tool.axis[0], tool.axis[1]) + (branch == Branch::positive_a ? 0 : std::numbers::pi);
  const double c = flat > 0 ? nearest_turn(turn, c_before_rad) : c_before_rad;
  return axes_at(tool.centre_mm, rotary_centre_mm, branch == Branch::positive_a ? tilt : -tilt, c);
}

ToolPose tool_of(const AxisPose& axes, const Vector3& rotary_centre_mm) {
  const double sa = std::sin(axes.a_rad);
  const double ca = std::cos(axes.a_rad);
  const double s = std::sin(axes.c_rad);
  const double c = std::cos(axes.c_rad);
  const double yr = ca * axes.y_mm + sa * axes.z_mm;
  const double z = -sa * axes.y_mm + ca * axes.z_mm;
  return {{c * axes.x_mm + s * yr + rotary_centre_mm[0], -s * axes.x_mm + c * yr + rotary_centre_mm[1],
           z + rotary_centre_mm[2]},
          {sa * s, sa * c, ca}};
}

ToolPose tilted(const ToolPose& tool, double radius_mm, double a_rad, double c_rad) {
  const Vector3 axis{std::sin(a_rad) * std::sin(c_rad), std::sin(a_rad) * std::cos(c_rad), std::cos(a_rad)};
  const double length = length_of(tool.axis);
  ToolPose moved{{}, axis};
  for (std::size_t i = 0; i < 3; ++i) {
    const double ball = tool.centre_mm[i] + radius_mm * tool.axis[i] / length;
    moved.centre_mm[i] = ball - radius_mm * axis[i];
  }
  return moved;
}

Result<std::vector<AxisPose>> choose_branches(std::span<const ToolPose> path, const Vector3& rotary_centre_mm,
                                              const BranchCosts& costs, std::optional<double> c_start_rad) {
  if (path.empty()) {
    return Error{ErrorCode::bad_argument, "five_axis: choose_branches: the path has no sample"};
  }
  std::vector<std::vector<Choice>> stages(path.size());
  for (std::size_t k = 0; k < path.size(); ++k) {
    const double length = length_of(path[k].axis);
    if (!(length > 0) || !std::isfinite(length)) {
      return Error{ErrorCode::bad_argument, fmt::format("five_axis: sample {}: the tool axis has no direction", k + 1)};
    }
    const Reachable sample(path[k], costs);
    if (k == 0) {
      const double middle = std::clamp(0.0, costs.c_min_rad, costs.c_max_rad);
      sample.begin(c_start_rad.value_or(middle), c_start_rad.has_value(), stages[0]);
    } else {
      for (std::size_t i = 0; i < stages[k - 1].size(); ++i) {
        sample.extend(stages[k - 1][i], i, stages[k]);
      }
      prune(stages[k]);
    }
    if (stages[k].empty()) {
      return no_branch(k, costs);
    }
  }
  std::size_t chosen =
      static_cast<std::size_t>(std::min_element(stages.back().begin(), stages.back().end(),
                                                [](const Choice& a, const Choice& b) { return a.cost < b.cost; }) -
                               stages.back().begin());
  std::vector<AxisPose> poses(path.size());
  for (std::size_t k = path.size(); k-- > 0;) {
    const Choice& choice = stages[k][chosen];
    poses[k] = axes_at(path[k].centre_mm, rotary_centre_mm, choice.a, choice.c);
    chosen = choice.from;
  }
  return poses;
}

}  // namespace gravure::motion
