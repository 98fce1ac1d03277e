#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gravure/motion/plan_profile.hpp"

namespace gravure::motion {

/// Moves of several axes that start and end together.
struct SynchronisedMove {
  std::vector<Profile> axes;  ///< in the order asked for; every access time is the same number
  std::size_t slowest_axis = 0;
  double access_time_s = 0;
};

/// The axis that takes longest decides. Axes from rest to rest are slowed down as a whole; axes with speed at an end
/// keep their jerk and acceleration limits and cruise slower. Fails with bad_argument for no axis and with
/// out_of_range, naming the axis, where an axis with speed at its ends cannot take that long.
Result<SynchronisedMove> synchronise(std::span<const JerkRequest> axes);

/// One axis in exactly `access_time_s`, which must not be shorter than its shortest time.
Result<Profile> plan_profile_lasting(const JerkRequest& request, double access_time_s);

}  // namespace gravure::motion
