#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "gravure/core/path_motion.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/texture/axis_limits.hpp"

namespace gravure::texture {

enum class LimitKind : std::uint8_t { speed, acceleration, jerk };
std::string_view limit_name(LimitKind kind) noexcept;

/// Where a limit of published_limits() comes from.
enum class LimitSource : std::uint8_t {
  published,  ///< it follows from what [A] states
  fitted,     ///< to the times that [A] states
  assumed,    ///< [A] does not state it, and its times do not show it
};
LimitSource source_of_published(std::size_t axis, LimitKind kind) noexcept;
std::string_view source_name(LimitSource source) noexcept;

/// The most that a motion asks of one limit of one axis.
struct LimitUse {
  std::size_t axis = 0;  ///< of kPathAxes
  LimitKind kind = LimitKind::speed;
  double most = 0;  ///< magnitude, mm or rad per s, s^2 or s^3
  double allowed = 0;
  std::int64_t instant = 0;  ///< where, the set-point at or before it
  double share() const noexcept { return most / allowed; }
};

/// Told of every period in which a limit is exceeded.
using LimitBreach = std::function<void(const LimitUse&)>;

/// Every limit of every axis over the whole of a motion, by the cubics that the servo runs between set-points
/// (cubic_motion()): largest and smallest speed of each cubic, its acceleration at both ends, its jerk. These are the
/// extremes of the continuous motion, so no density of looking could find more. Errors as PathMotion::read(); cancelled
/// on request; bad_argument as check_limits(). More than one of `threads` read different parts at once, which the
/// motion must bear; `breach` is told one at a time, in any order then. `progress` is told how many periods are done.
Result<std::vector<LimitUse>> prove_limits(const PathMotion& motion, const AxesLimits& limits, double servo_s,
                                           const CancelToken& cancel, const LimitBreach& breach = {}, int threads = 1,
                                           Progress* progress = nullptr);

/// The uses that are above what is allowed by more than a rounding: 1e-6 of it.
std::vector<LimitUse> broken(std::span<const LimitUse> uses);

}  // namespace gravure::texture
