#pragma once

#include <cstdint>

#include "gravure/core/job.hpp"
#include "violations.hpp"

namespace gravure::sync_plan {

/// Largest number of slots, lines, pixels or encoder lines: beyond any machine, small enough for products of a few.
inline constexpr std::int64_t kMostCount = 1'000'000'000;
inline constexpr std::int64_t kMostGearTurns = 1'000'000;  ///< on either side
/// Each candidate costs a best pair of some microseconds.
inline constexpr std::int64_t kMostTurnSlots = 10'000'000;
inline constexpr std::int64_t kMostExtraSlots = 100'000;
/// The board's registers prescaler and fraction_den (docs/registers.md).
inline constexpr std::int64_t kMostPrescaler = 4'294'967'295;
inline constexpr std::int64_t kMostFractionDen = (std::int64_t{1} << 34) - 1;
/// Revolutions that the plan counts by itself: of a helical job, of all bands together.
inline constexpr std::int64_t kMostRevolutions = 1'000'000;

/// Refuses values no plan can be computed from, each by itself, and keys that exclude each other.
void check_fields(const Job& job, std::int64_t columns, std::int64_t exposures, Violations& violations);

}  // namespace gravure::sync_plan
