#pragma once

#include <string_view>

#include "gravure/core/error.hpp"
#include "gravure/motion/plan_profile.hpp"

namespace gravure::motion {

/// Longest jerk segment, in updates.
inline constexpr double kMostSFactor = 1e9;

/// out_of_range unless low <= value <= high; the message names `field`.
Result<void> check_range(std::string_view field, double value, double low, double high);
Result<void> check_move(const Move& move);
Result<void> check_request(const SFactorRequest& request);
Result<void> check_request(const JerkRequest& request);

}  // namespace gravure::motion
