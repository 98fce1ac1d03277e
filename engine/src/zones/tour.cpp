#include "gravure/zones/tour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "gravure/motion/plan_profile.hpp"
#include "tour_order.hpp"

namespace gravure::zones {
namespace {

using kinematics::Branch;
using kinematics::Joint;
using kinematics::JointKind;

constexpr double kTurn = 2 * std::numbers::pi;

/// Turns freely: only where it stands within a turn matters.
bool is_endless(const Joint& joint) {
  return joint.kind == JointKind::revolute && !joint.limits.least && !joint.limits.most;
}

/// One way to visit a zone: the poses of its layers.
using Way = std::vector<JointPositions>;

/// The layers from one branch, turns as they come next to 0; the error of the first that cannot be reached.
Result<Way> follow_branch(const Machine& machine, const Stops& stops, Branch branch) {
  Way way;
  kinematics::InverseRequest request;
  request.branch = branch;
  request.near.assign(machine.joints.size(), 0);
  for (std::size_t layer = 0; layer < stops.layers.size(); ++layer) {
    Result<kinematics::Pose> pose = kinematics::inverse(machine, stops.layers[layer], request);
    if (!pose) {
      return Error{pose.error().code, fmt::format("layer {}: {}", layer, pose.error().message)};
    }
    request.near = pose.value().joints;
    way.push_back(std::move(pose).value().joints);
  }
  return way;
}

/// The same way with other whole turns of the joints that have limits, as far as these allow.
std::vector<Way> with_turns(const Machine& machine, const Way& way) {
  std::vector<Way> ways{way};
  constexpr int kMostTurns = 3;
  for (std::size_t j = 0; j < machine.joints.size(); ++j) {
    const Joint& joint = machine.joints[j];
    if (joint.kind != JointKind::revolute || is_endless(joint)) {
      continue;
    }
    const std::size_t count = ways.size();
    for (int turns = -kMostTurns; turns <= kMostTurns; ++turns) {
      for (std::size_t w = 0; turns != 0 && w < count; ++w) {
        Way other = ways[w];
        bool allowed = true;
        for (JointPositions& pose : other) {
          pose[j] += kTurn * turns;
          allowed = allowed && pose[j] >= joint.limits.least.value_or(pose[j]) &&
                    pose[j] <= joint.limits.most.value_or(pose[j]);
        }
        if (allowed) {
          ways.push_back(std::move(other));
        }
      }
    }
  }
  return ways;
}

Result<std::vector<Way>> ways_of(const Machine& machine, const Stops& stops) {
  std::vector<Way> ways;
  std::optional<Error> error;
  for (const Branch branch : {Branch::positive, Branch::negative}) {
    Result<Way> way = follow_branch(machine, stops, branch);
    if (!way) {
      error = error ? error : way.error();
      continue;
    }
    const bool is_new = std::find(ways.begin(), ways.end(), way.value()) == ways.end();
    for (Way& turned : is_new ? with_turns(machine, way.value()) : std::vector<Way>{}) {
      ways.push_back(std::move(turned));
    }
  }
  if (ways.empty()) {
    return *error;
  }
  return ways;
}

/// `to` with the turns of endless joints next to `from`.
JointPositions nearest(const Machine& machine, const JointPositions& from, JointPositions to) {
  for (std::size_t j = 0; j < to.size(); ++j) {
    if (is_endless(machine.joints[j])) {
      to[j] = kinematics::nearest_turn(to[j], from[j]);
    }
  }
  return to;
}

/// Time of the move with the endless joints going the short way round.
Result<double> time_between(const Machine& machine, const JointPositions& from, const JointPositions& to) {
  return move_time_s(machine, from, nearest(machine, from, to));
}

struct Ways {
  std::vector<Way> all;
  TourTimes times;
};

Result<Ways> time_ways(const Machine& machine, const std::vector<Stops>& zones, const JointPositions& start,
                       const ZoneWatch& watch) {
  Ways ways;
  ways.times.first.push_back(0);
  for (std::size_t z = 0; z < zones.size(); ++z) {
    Result<std::vector<Way>> of_zone = ways_of(machine, zones[z]);
    if (!of_zone) {
      return Error{of_zone.error().code, fmt::format("zone {}: {}", z, of_zone.error().message)};
    }
    for (Way& way : of_zone.value()) {
      ways.all.push_back(std::move(way));
    }
    ways.times.first.push_back(ways.all.size());
  }
  for (const Way& way : ways.all) {
    GRAVURE_TRY(const double begin, time_between(machine, start, way.front()));
    ways.times.begin_s.push_back(begin);
    double inside = 0;
    for (std::size_t layer = 1; layer < way.size(); ++layer) {
      GRAVURE_TRY(const double time, time_between(machine, way[layer - 1], way[layer]));
      inside += time;
    }
    ways.times.inside_s.push_back(inside);
  }
  for (const Way& from : ways.all) {
    GRAVURE_CHECK(watch.go_on());
    watch.tell(ZonePart::tour, ways.times.between_s.size(), 2 * ways.all.size());  // and as long for the order
    std::vector<double> row;
    for (const Way& to : ways.all) {
      GRAVURE_TRY(const double time, time_between(machine, from.back(), to.front()));
      row.push_back(time);
    }
    ways.times.between_s.push_back(std::move(row));
  }
  return ways;
}

/// Zones as they are given, each in its first way.
double naive_time(const TourTimes& times) {
  double time = 0;
  for (std::size_t z = 0; z < times.zones(); ++z) {
    const std::size_t way = times.first[z];
    time += (z == 0 ? times.begin_s[way] : times.between_s[times.first[z - 1]][way]) + times.inside_s[way];
  }
  return time;
}

}  // namespace

Result<void> check_limits(const Machine& machine) {
  for (const Joint& joint : machine.joints) {
    const char* const missing = !joint.limits.max_speed          ? "max_speed"
                                : !joint.limits.max_acceleration ? "max_acceleration"
                                : !joint.limits.max_jerk         ? "max_jerk"
                                                                 : nullptr;
    if (missing != nullptr) {
      return Error{ErrorCode::bad_argument,
                   fmt::format("machine: joint {} has no {}: speed, acceleration and jerk are needed to time its moves",
                               joint.name, missing)};
    }
  }
  return {};
}

Result<void> check_travel(const Machine& machine, const Stops& stops) {
  GRAVURE_CHECK(ways_of(machine, stops));
  return {};
}

Result<double> move_time_s(const Machine& machine, const JointPositions& from, const JointPositions& to) {
  double time = 0;
  for (std::size_t j = 0; j < machine.joints.size(); ++j) {
    const kinematics::JointLimits& limits = machine.joints[j].limits;
    const double stroke = to[j] - from[j];
    if (stroke == 0) {
      continue;
    }
    const motion::Move move{stroke, *limits.max_speed, *limits.max_acceleration, *limits.max_acceleration, 0, 0};
    GRAVURE_TRY(const motion::Profile profile,
                motion::plan_profile(motion::JerkRequest{move, *limits.max_jerk, *limits.max_jerk}));
    time = std::max(time, profile.access_time_s());
  }
  return time;
}

Result<Tour> plan_tour(const Machine& machine, const std::vector<Stops>& zones, const JointPositions& start,
                       const ZoneWatch& watch) {
  GRAVURE_CHECK(check_limits(machine));
  if (zones.empty() || start.size() != machine.joints.size() ||
      std::any_of(zones.begin(), zones.end(), [](const Stops& stops) { return stops.layers.empty(); })) {
    return Error{ErrorCode::bad_argument, "a tour needs a zone, a layer in each, and a start for each joint"};
  }
  GRAVURE_TRY(Ways ways, time_ways(machine, zones, start, watch));
  const TourOrder order = shortest_order(ways.times, watch);
  GRAVURE_CHECK(watch.go_on());
  Tour tour;
  tour.time_s = order.time_s;
  tour.naive_time_s = naive_time(ways.times);
  tour.is_proved = order.is_proved;
  JointPositions at = start;
  for (const std::size_t way : order.ways) {
    const auto after = std::upper_bound(ways.times.first.begin(), ways.times.first.end(), way);
    tour.order.push_back(static_cast<std::size_t>(after - ways.times.first.begin() - 1));
    std::vector<JointPositions> poses;
    for (JointPositions& pose : ways.all[way]) {
      at = nearest(machine, at, std::move(pose));
      poses.push_back(at);
    }
    tour.poses.push_back(std::move(poses));
  }
  return tour;
}

}  // namespace gravure::zones
