#pragma once

#include "gravure/texture/path_timing.hpp"

namespace gravure::texture {

/// Servo periods that a motion may have: 7.4 h at 50 us. What is kept of one, and the time to plan it, grow with them.
inline constexpr std::int64_t kMostPeriods = std::int64_t{1} << 29;

/// Refuses, before anything is reckoned, limits so low that the motion had more periods than that at least, naming axis
/// and limit: out_of_range. A bound from below: an axis stands still where it turns, its acceleration being free there,
/// so each of its ways from turn to turn takes the time that speed, acceleration or jerk alone asks for. U and V turn
/// elsewhere, too, where the stages are ahead or behind: half of that counts.
Result<void> check_least_time(const PathTimingRequest& request);

/// The same of a motion that has turned out to be too long.
Error too_long(double periods, double servo_s);

}  // namespace gravure::texture
