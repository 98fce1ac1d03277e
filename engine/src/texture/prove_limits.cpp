#include "gravure/texture/prove_limits.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <future>
#include <mutex>

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

using AllAxes = Eigen::Array<double, kPathAxes.size(), 1>;  // eight go in pairs; W is 0 where there is none

AllAxes all_axes(const PathInstant& at) {
  static_assert(sizeof(at.axes) == sizeof(AllAxes));
  AllAxes all;
  std::memcpy(all.data(), at.axes.data(), sizeof(at.axes));
  return all;
}

/// The extremes of a whole block, all axes at once; finite only where every axis is.
struct BlockExtremes {
  std::array<AllAxes, kKinds> most{AllAxes::Zero(), AllAxes::Zero(), AllAxes::Zero()};
  bool finite = true;
};

BlockExtremes block_extremes(std::span<const PathInstant> block) {
  BlockExtremes found;
  AllAxes speed = AllAxes::Zero();
  AllAxes acceleration = AllAxes::Zero();
  AllAxes jerk = AllAxes::Zero();
  AllAxes sum = AllAxes::Zero();
  AllAxes here = all_axes(block[2]);
  AllAxes first = here - all_axes(block[1]);
  AllAxes before = first - (all_axes(block[1]) - all_axes(block[0]));
  for (std::size_t k = 3; k < block.size(); ++k) {
    const AllAxes next = all_axes(block[k]);
    const AllAxes after = (next - here) - first;
    const AllAxes change = after - before;
    const AllAxes begin = first - before / 2 - change / 6;
    const AllAxes turn = begin - before * before / (2 * change);  // where the acceleration is 0
    speed = speed.max(begin.abs()).max((first + before / 2 + change / 3).abs());
    speed = speed.max((before * after < 0).select(turn.abs(), speed));
    acceleration = acceleration.max(after.abs()).max(before.abs());
    jerk = jerk.max(change.abs());
    sum += change;
    first = next - here;
    here = next;
    before = after;
  }
  found.most = {speed, acceleration, jerk};
  found.finite = sum.isFinite().all();
  return found;
}

class Uses {
 public:
  Uses(const AxesLimits& limits, double servo_s, const LimitBreach& breach)
      : uses_(limits.size() * kKinds), breach_(breach) {
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
  /// Looks into a block only where it holds more than is known, or than is allowed.
  void look(std::span<const PathInstant> block, std::int64_t begin) {
    if (block.size() < 4) {
      return;
    }
    const BlockExtremes found = block_extremes(block);
    constexpr double kSure = 1 + 1e-12;  // the sums above are done in another order
    bool more = !found.finite;
    for (std::size_t k = 0; k < uses_.size(); ++k) {
      const auto axis = static_cast<Eigen::Index>(uses_[k].axis);
      const double most = found.most[k % kKinds][axis] * per_unit_[k % kKinds] * kSure;
      more = more || !(most <= std::min(uses_[k].most, uses_[k].allowed));
    }
    for (std::size_t k = 0; more && k + 3 < block.size(); ++k) {
      look_at(block.subspan(k, 4), begin + static_cast<std::int64_t>(k));
    }
  }
  std::vector<LimitUse> uses() const { return uses_; }
  /// What a later part of the same motion has found.
  void join(const Uses& later) {
    for (std::size_t k = 0; k < uses_.size(); ++k) {
      if (!(later.uses_[k].most <= uses_[k].most)) {
        uses_[k] = later.uses_[k];
      }
    }
  }

 private:
  void look_at(std::span<const PathInstant> four, std::int64_t instant) {
    for (std::size_t axis = 0; axis * kKinds < uses_.size(); ++axis) {
      const std::array<double, 4> x{four[0].axes[axis], four[1].axes[axis], four[2].axes[axis], four[3].axes[axis]};
      const std::array<double, kKinds> most = extremes(x);
      for (std::size_t kind = 0; kind < kKinds; ++kind) {
        note(uses_[axis * kKinds + kind], most[kind] * per_unit_[kind], instant);
      }
    }
  }
  void note(LimitUse& use, double value, std::int64_t instant) const {
    if (breach_ && value > use.allowed * (1 + kRounding)) {
      breach_({use.axis, use.kind, value, use.allowed, instant});
    }
    if (!(value <= use.most)) {
      use.most = value;
      use.instant = instant;
    }
  }
  std::vector<LimitUse> uses_;
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

Result<std::vector<LimitUse>> prove_limits(const PathMotion& motion, const AxesLimits& limits, double servo_s,
                                           const CancelToken& cancel, const LimitBreach& breach, int threads,
                                           Progress* progress) {
  GRAVURE_CHECK(check_limits(limits));
  std::mutex one_at_a_time;
  LimitBreach told;
  if (breach) {
    told = [&](const LimitUse& use) {
      const std::lock_guard lock(one_at_a_time);
      breach(use);
    };
  }
  const std::int64_t periods = std::max<std::int64_t>(motion.instants() - 1, 0);
  const std::int64_t parts = std::clamp<std::int64_t>(threads, 1, 64);
  std::vector<Uses> uses(static_cast<std::size_t>(parts), Uses(limits, servo_s, told));
  const auto prove_part = [&](std::int64_t part) {
    Uses& mine = uses[static_cast<std::size_t>(part)];
    return for_each_block(motion, {periods * part / parts, periods * (part + 1) / parts}, cancel,
                          "stopped while limits were being checked",
                          [&](std::span<const PathInstant> block, std::int64_t begin) {
                            mine.look(block, begin);
                            if (part == 0 && progress != nullptr) {  // the other parts are as long
                              progress->update(begin * parts, periods);
                            }
                          });
  };
  std::vector<std::future<Result<void>>> others;
  for (std::int64_t part = 1; part < parts; ++part) {
    others.push_back(std::async(std::launch::async, prove_part, part));
  }
  Result<void> outcome = prove_part(0);
  for (std::size_t k = 0; k < others.size(); ++k) {
    Result<void> other = others[k].get();
    if (outcome) {
      outcome = std::move(other);
    }
    uses[0].join(uses[k + 1]);
  }
  if (!outcome) {
    return outcome.error();
  }
  return uses[0].uses();
}

std::vector<LimitUse> broken(std::span<const LimitUse> uses) {
  std::vector<LimitUse> found;
  std::copy_if(uses.begin(), uses.end(), std::back_inserter(found),
               [](const LimitUse& use) { return !(use.share() <= 1 + kRounding); });
  return found;
}

}  // namespace gravure::texture
