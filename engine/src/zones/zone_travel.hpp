#pragma once

#include <functional>
#include <vector>

#include "gravure/kinematics/machine.hpp"
#include "zone_of.hpp"

namespace gravure::zones {

/// Whether the machine reaches all that is marked of a zone seen from its direction; the error says what stops it.
using ZoneCheck = std::function<Result<void>(const Zone&)>;

/// A zone whose direction is outside the travel of a joint is turned to the nearest direction found from which it is
/// within travel and within the limits: from its own on the way to that allowed direction which is nearest to the beam
/// with all joints at 0, or to the opposite. Where there is none for all its pieces, it is halved until there is one
/// for each part. out_of_range, naming a contour by `contours`, where a piece alone is out of travel.
Result<std::vector<Zone>> zones_within_travel(const std::vector<Contour>& contours, const std::vector<Piece>& pieces,
                                              const ZoneLimits& limits, const kinematics::Machine& machine,
                                              const ZoneCheck& check, const Zone& zone);

}  // namespace gravure::zones
