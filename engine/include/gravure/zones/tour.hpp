#pragma once

#include <cstddef>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/kinematics/inverse.hpp"
#include "gravure/kinematics/machine.hpp"
#include "gravure/zones/zone_watch.hpp"

namespace gravure::zones {

using kinematics::JointPositions;
using kinematics::Machine;

/// What the stages do for one zone: the targets of its layers, the top one first.
struct Stops {
  std::vector<kinematics::Target> layers;
};

/// Zones one after the other.
struct Tour {
  std::vector<std::size_t> order;                  ///< of the zones
  std::vector<std::vector<JointPositions>> poses;  ///< in that order, layer by layer; turns of C counted on
  double time_s = 0;                               ///< of all stage moves
  double naive_time_s = 0;                         ///< zones as given, A >= 0, C by the nearest turn
  bool is_proved = false;                          ///< no order, branch or turn is faster
};

/// Fails with bad_argument, naming the joint, where speed, acceleration or jerk limits are missing.
Result<void> check_limits(const Machine& machine);

/// Whether every stop of a zone is within travel, from one branch of A at least; errors as kinematics::inverse(),
/// naming the layer.
Result<void> check_travel(const Machine& machine, const Stops& stops);

/// Time of a synchronised move from rest to rest under the machine's limits ([C1] profiles, engine/motion).
Result<double> move_time_s(const Machine& machine, const JointPositions& from, const JointPositions& to);

/// The order of zones, the branch of A for each and the turns of C that take the least time from `start` to the last
/// layer. Proved by dynamic programming up to 12 zones; beyond, 2-opt and Or-opt from the nearest neighbour, the
/// branches by dynamic programming along the order. Where the direction is along C's axis, C stands at 0. Errors as
/// check_limits(), and as kinematics::inverse() naming zone and layer where no branch reaches it; cancelled.
Result<Tour> plan_tour(const Machine& machine, const std::vector<Stops>& zones, const JointPositions& start,
                       const ZoneWatch& watch = {});

}  // namespace gravure::zones
