#pragma once

#include "gravure/texture/path_timing.hpp"

namespace gravure::texture {

/// Servo periods that a motion may have: 30 h at 50 us. What is kept of one grows with them.
inline constexpr std::int64_t kMostPeriods = std::int64_t{1} << 31;

/// Refuses, before anything is reckoned, limits so low that the motion had more periods than that at least, naming axis
/// and limit: out_of_range. A bound from below: an axis stands still where it turns, so going from one end of its range
/// to the other takes it 0.7 times what a move from rest to rest would (its acceleration is free at both ends).
Result<void> check_least_time(const PathTimingRequest& request);

/// The same of a motion that has turned out to be too long.
Error too_long(double periods, double servo_s);

}  // namespace gravure::texture
