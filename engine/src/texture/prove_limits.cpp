#include "gravure/texture/prove_limits.hpp"

#include <algorithm>
#include <cmath>

#include "gravure/core/path_expand.hpp"
#include "motion_windows.hpp"

namespace gravure::texture {
namespace {

constexpr double kRounding = 1e-6;
constexpr std::size_t kKinds = 3;

double limit(const AxisBounds& bounds, std::size_t kind) {
  return kind == 0 ? bounds.speed : kind == 1 ? bounds.acceleration : bounds.jerk;
}

/// Extremes of one cubic, a period long, in units of the period.
std::array<double, kKinds> extremes(const std::array<double, 4>& x) {
  const double before = x[2] - 2 * x[1] + x[0];
  const double after = x[3] - 2 * x[2] + x[1];
  const double jerk = after - before;
  double speed = std::max(std::abs(cubic_motion(x, 0).speed), std::abs(cubic_motion(x, 1).speed));
  if ((before < 0) != (after < 0)) {
    speed = std::max(speed, std::abs(cubic_motion(x, -before / jerk).speed));
  }
  return {speed, std::max(std::abs(before), std::abs(after)), std::abs(jerk)};
}

class Uses {
 public:
  Uses(const SevenLimits& limits, double servo_s, const LimitBreach& breach) : breach_(breach) {
    for (std::size_t axis = 0; axis < limits.size(); ++axis) {
      double unit = 1;
      for (std::size_t kind = 0; kind < kKinds; ++kind) {
        unit *= servo_s;
        LimitUse& use = uses_[axis * kKinds + kind];
        use.axis = axis;
        use.kind = static_cast<LimitKind>(kind);
        use.allowed = limit(limits[axis], kind);
        per_unit_[kind] = 1 / unit;
      }
    }
  }
  void look(std::span<const PathInstant> four, std::int64_t instant) {
    for (std::size_t axis = 0; axis < kPathAxes.size(); ++axis) {
      const std::array<double, 4> x{four[0].axes[axis], four[1].axes[axis], four[2].axes[axis], four[3].axes[axis]};
      const std::array<double, kKinds> most = extremes(x);
      for (std::size_t kind = 0; kind < kKinds; ++kind) {
        note(uses_[axis * kKinds + kind], most[kind] * per_unit_[kind], instant);
      }
    }
  }
  std::vector<LimitUse> uses() const { return {uses_.begin(), uses_.end()}; }

 private:
  void note(LimitUse& use, double value, std::int64_t instant) const {
    if (breach_ && value > use.allowed * (1 + kRounding)) {
      breach_({use.axis, use.kind, value, use.allowed, instant});
    }
    if (!(value <= use.most)) {
      use.most = value;
      use.instant = instant;
    }
  }
  std::array<LimitUse, kPathAxes.size() * kKinds> uses_;
  std::array<double, kKinds> per_unit_{};
  const LimitBreach& breach_;
};

}  // namespace

std::string_view limit_name(LimitKind kind) noexcept {
  switch (kind) {
    case LimitKind::speed:
      return "speed";
    case LimitKind::acceleration:
      return "acceleration";
    case LimitKind::jerk:
      break;
  }
  return "jerk";
}

LimitSource source_of_published(std::size_t axis, LimitKind kind) noexcept {
  const std::string_view name = kPathAxes[axis];
  if (kind == LimitKind::speed || name == "Z") {
    return LimitSource::assumed;
  }
  return name == "A" || name == "C" ? LimitSource::fitted : LimitSource::published;
}

std::string_view source_name(LimitSource source) noexcept {
  switch (source) {
    case LimitSource::published:
      return "published";
    case LimitSource::fitted:
      return "fitted";
    case LimitSource::assumed:
      break;
  }
  return "assumed";
}

Result<std::vector<LimitUse>> prove_limits(const PathMotion& motion, const SevenLimits& limits, double servo_s,
                                           const CancelToken& cancel, const LimitBreach& breach) {
  Uses uses(limits, servo_s, breach);
  GRAVURE_CHECK(for_each_window(
      motion, cancel, "stopped while limits were being checked",
      [&uses](std::span<const PathInstant, 4> four, std::int64_t instant) { uses.look(four, instant); }));
  return uses.uses();
}

std::vector<LimitUse> broken(std::span<const LimitUse> uses) {
  std::vector<LimitUse> found;
  std::copy_if(uses.begin(), uses.end(), std::back_inserter(found),
               [](const LimitUse& use) { return !(use.share() <= 1 + kRounding); });
  return found;
}

}  // namespace gravure::texture
