#include "gravure/texture/following_error.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "motion_windows.hpp"
#include "off_the_point.hpp"
#include "servo_step.hpp"

namespace gravure::texture {

using kinematics::Vector3;

namespace {

/// Keeps the largest and the mean square.
class Worst {
 public:
  void take(double value, std::int64_t instant) noexcept {
    const double magnitude = std::abs(value);
    squares_ += value * value;
    ++count_;
    if (magnitude > error_.max) {
      error_.max = magnitude;
      error_.instant = instant;
    }
  }
  FollowingError result() const noexcept {
    FollowingError error = error_;
    error.rms = count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0;
    return error;
  }

 private:
  FollowingError error_;
  double squares_ = 0;
  std::int64_t count_ = 0;
};

using AxisErrors = std::array<double, kPathAxes.size()>;

class Prediction {
 public:
  Prediction(const AxesServos& servos, const RotaryTable& table, double servo_s) : table_(table) {
    loops_.reserve(servos.size());
    axes_.resize(servos.size());
    for (const ServoLoop& servo : servos) {
      loops_.emplace_back(servo, servo_s);
    }
  }
  void step(std::span<const PathInstant, 4> four, std::int64_t begin) {
    AxisErrors behind{};
    for (std::size_t axis = 0; axis < loops_.size(); ++axis) {
      loops_[axis].step({four[0].axes[axis], four[1].axes[axis], four[2].axes[axis], four[3].axes[axis]});
      behind[axis] = loops_[axis].behind();
      axes_[axis].take(behind[axis], begin + 1);
    }
    const Vector3 off = off_the_point(table_, four[2].axes, behind);
    spot_.take(off.head<2>().norm(), begin + 1);
    focus_.take(off.z(), begin + 1);
  }
  FollowingErrors result() const {
    FollowingErrors errors;
    for (const Worst& axis : axes_) {
      errors.axes.push_back(axis.result());
    }
    errors.spot_mm = spot_.result();
    errors.focus_mm = focus_.result();
    return errors;
  }

 private:
  RotaryTable table_;
  std::vector<ServoStep> loops_;
  std::vector<Worst> axes_;
  Worst spot_;
  Worst focus_;
};

}  // namespace

Vector3 off_the_point(const RotaryTable& table, const std::array<double, kPathAxes.size()>& axes,
                      const std::array<double, kPathAxes.size()>& behind) {
  const Vector3 sense(1, table.sense, 1);
  const Vector3 point(axes[0] + axes[5], axes[1] + axes[6], axes[2] + axes[kFocusAxis]);
  const double a_rad = table.sense * axes[3];
  const Vector3 c_axis(0, -std::sin(a_rad), std::cos(a_rad));
  const Vector3 turn = table.sense * (behind[3] * Vector3::UnitX() + behind[4] * c_axis);
  const Vector3 turned = turn.cross(sense.cwiseProduct(point));
  return sense.cwiseProduct(turned) -
         Vector3(behind[0] + behind[5], behind[1] + behind[6], behind[2] + behind[kFocusAxis]);
}

AxesServos assumed_servos(bool focus_axis) {
  constexpr double kDamping = 0.7;
  const ServoLoop linear{50, kDamping};
  const ServoLoop rotary{30, kDamping};
  const ServoLoop galvo{1000, kDamping};
  AxesServos servos{linear, linear, linear, rotary, rotary, galvo, galvo};
  if (focus_axis) {
    servos.push_back(linear);
  }
  return servos;
}

Result<void> check_servos(const AxesServos& servos) {
  constexpr double kMost_hz = 1e6;
  constexpr double kMostDamping = 100;
  if (servos.size() != kFocusAxis && servos.size() != kPathAxes.size()) {
    return Error{ErrorCode::bad_argument, fmt::format("servos of {} axes: must be {}, or {} with a focus axis",
                                                      servos.size(), kFocusAxis, kPathAxes.size())};
  }
  for (std::size_t axis = 0; axis < servos.size(); ++axis) {
    const ServoLoop& servo = servos[axis];
    if (!(servo.natural_hz > 0 && servo.natural_hz <= kMost_hz && servo.damping > 0 && servo.damping <= kMostDamping)) {
      return Error{ErrorCode::out_of_range,
                   fmt::format("axis {}: servo of {} Hz and damping {}: must be above 0, at most {} Hz and {}",
                               kPathAxes[axis], servo.natural_hz, servo.damping, kMost_hz, kMostDamping)};
    }
  }
  return {};
}

Result<FollowingErrors> predict_following(const PathMotion& motion, const AxesServos& servos, const RotaryTable& table,
                                          double servo_s, const CancelToken& cancel) {
  GRAVURE_CHECK(check_servos(servos));
  Prediction prediction(servos, table, servo_s);
  GRAVURE_CHECK(for_each_window(
      motion, cancel, "stopped while following errors were being predicted",
      [&prediction](std::span<const PathInstant, 4> four, std::int64_t begin) { prediction.step(four, begin); }));
  return prediction.result();
}

}  // namespace gravure::texture
