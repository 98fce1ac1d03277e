#include "gravure/zones/tour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "dice.hpp"
#include "gravure/motion/synchronise.hpp"
#include "gravure/zones/plan_zones.hpp"
#include "tour_order.hpp"

namespace gravure::zones {
namespace {

TourTimes random_times(test::Dice& dice, std::size_t zones) {
  TourTimes times;
  times.first.push_back(0);
  const auto time = [&dice] { return static_cast<double>(dice.between(1, 1000)) / 100; };
  for (std::size_t z = 0; z < zones; ++z) {
    times.first.push_back(times.first.back() + static_cast<std::size_t>(dice.between(1, 3)));
  }
  for (std::size_t w = 0; w < times.first.back(); ++w) {
    times.begin_s.push_back(time());
    times.inside_s.push_back(time());
  }
  times.between_s.assign(times.begin_s.size(), {});
  for (auto& row : times.between_s) {
    for (std::size_t w = 0; w < times.begin_s.size(); ++w) {
      row.push_back(time());
    }
  }
  return times;
}

double time_of(const TourTimes& times, const std::vector<std::size_t>& ways) {
  double sum = times.begin_s[ways[0]] + times.inside_s[ways[0]];
  for (std::size_t i = 1; i < ways.size(); ++i) {
    sum += times.between_s[ways[i - 1]][ways[i]] + times.inside_s[ways[i]];
  }
  return sum;
}

/// Every order of zones with every choice of ways.
double shortest_by_force(const TourTimes& times) {
  std::vector<std::size_t> order(times.zones());
  std::iota(order.begin(), order.end(), std::size_t{0});
  double least = std::numeric_limits<double>::infinity();
  do {
    std::vector<std::size_t> ways;
    for (const std::size_t z : order) {
      ways.push_back(times.first[z]);
    }
    for (bool more = true; more;) {
      least = std::min(least, time_of(times, ways));
      more = false;
      for (std::size_t i = 0; i < ways.size() && !more; ++i) {
        more = ++ways[i] < times.first[order[i] + 1];
        ways[i] = more ? ways[i] : times.first[order[i]];
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return least;
}

TEST(ShortestOrder, IsTheShortestOfAll) {
  SCOPED_TRACE(test::Dice::note());
  test::Dice dice(71);
  for (int trial = 0; trial < 60; ++trial) {
    const TourTimes times = random_times(dice, static_cast<std::size_t>(dice.between(1, 6)));
    const TourOrder order = shortest_order(times);
    EXPECT_TRUE(order.is_proved);
    EXPECT_NEAR(order.time_s, shortest_by_force(times), 1e-9);
    EXPECT_NEAR(order.time_s, time_of(times, order.ways), 1e-9);
  }
}

TEST(ShortestOrder, VisitsManyZonesOnceEach) {
  SCOPED_TRACE(test::Dice::note());
  test::Dice dice(72);
  const TourTimes times = random_times(dice, 25);
  const TourOrder order = shortest_order(times);
  EXPECT_FALSE(order.is_proved);
  EXPECT_NEAR(order.time_s, time_of(times, order.ways), 1e-9);
  std::vector<std::size_t> zones;
  for (const std::size_t way : order.ways) {
    zones.push_back(static_cast<std::size_t>(std::upper_bound(times.first.begin(), times.first.end(), way) -
                                             times.first.begin() - 1));
  }
  std::vector<std::size_t> as_given(25);
  std::iota(as_given.begin(), as_given.end(), std::size_t{0});
  EXPECT_LT(order.time_s, best_ways(times, as_given).time_s);
  std::sort(zones.begin(), zones.end());
  EXPECT_EQ(zones, as_given);
}

/// Zones whose directions lie round the z axis of the part, far from the pole.
std::vector<Stops> ring(std::size_t count, const std::vector<std::size_t>& order) {
  std::vector<Stops> zones;
  for (const std::size_t i : order) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const Vector3 direction(std::cos(turn) * 0.6, std::sin(turn) * 0.6, 0.8);
    zones.push_back({{{30 * direction, direction}, {29.5 * direction, direction}}});
  }
  return zones;
}

TEST(PlanTour, GoesRoundInsteadOfToAndFro) {
  const Machine machine = example_machine();
  const JointPositions start(machine.joints.size(), 0);
  const Tour tour = plan_tour(machine, ring(8, {0, 4, 1, 5, 2, 6, 3, 7}), start).value();
  EXPECT_TRUE(tour.is_proved);
  EXPECT_LT(tour.time_s, 0.7 * tour.naive_time_s);
  // The time is that of the moves, each by the synchronised profiles of engine/motion.
  double time = 0;
  JointPositions at = start;
  for (std::size_t z = 0; z < tour.poses.size(); ++z) {
    for (const JointPositions& pose : tour.poses[z]) {
      std::vector<motion::JerkRequest> axes;
      for (std::size_t j = 0; j < pose.size(); ++j) {
        const auto& limits = machine.joints[j].limits;
        axes.push_back({{pose[j] - at[j], *limits.max_speed, *limits.max_acceleration, *limits.max_acceleration, 0, 0},
                        *limits.max_jerk,
                        *limits.max_jerk});
      }
      time += motion::synchronise(axes).value().access_time_s;
      at = pose;
    }
  }
  EXPECT_NEAR(tour.time_s, time, 1e-9);
}

TEST(PlanTour, PosesBringEachLayerUnderTheBeamTopFirst) {
  const Machine machine = example_machine();
  const std::vector<Stops> zones = ring(5, {0, 1, 2, 3, 4});
  const Tour tour = plan_tour(machine, zones, JointPositions(machine.joints.size(), 0)).value();
  for (std::size_t step = 0; step < tour.order.size(); ++step) {
    const Stops& stops = zones[tour.order[step]];
    ASSERT_EQ(tour.poses[step].size(), stops.layers.size());
    for (std::size_t layer = 0; layer < stops.layers.size(); ++layer) {
      const kinematics::Spot spot = forward(machine, tour.poses[step][layer], {});
      EXPECT_LT((spot.position_mm - stops.layers[layer].position_mm).norm(), 1e-9);
      EXPECT_LT((spot.towards_head - *stops.layers[layer].towards_head).norm(), 1e-9);
    }
  }
}

TEST(PlanTour, TakesTheOtherBranchWhereItIsShorter) {
  // From C = 0, A = 0 a direction behind is reached with A < 0 without turning C by half a turn.
  Machine machine = example_machine();
  const Vector3 direction(0, 0.6, 0.8);
  const std::vector<Stops> zones{{{{Vector3::Zero(), direction}}}};
  const Tour tour = plan_tour(machine, zones, JointPositions(5, 0)).value();
  EXPECT_LT(std::abs(tour.poses[0][0][4]), 1e-9);
  EXPECT_LT(tour.time_s, tour.naive_time_s + 1e-12);
  machine.joints[3].limits.least = 0;  // A cannot go there
  const Tour other = plan_tour(machine, zones, JointPositions(5, 0)).value();
  EXPECT_NEAR(std::abs(other.poses[0][0][4]), std::numbers::pi, 1e-9);
  EXPECT_GT(other.time_s, tour.time_s);
}

TEST(PlanTour, CountsTurnsOnWhereCHasNoLimitsAndKeepsThemWhereItHas) {
  Machine machine = example_machine();
  machine.joints[3].limits.least = 0;
  JointPositions start(5, 0);
  start[4] = 3;
  const std::vector<Stops> zones = ring(6, {0, 1, 2, 3, 4, 5});
  const Tour free = plan_tour(machine, zones, start).value();
  machine.joints[4].limits.least = -3.3;
  machine.joints[4].limits.most = 3.3;
  const Tour bounded = plan_tour(machine, zones, start).value();
  EXPECT_GE(bounded.time_s, free.time_s - 1e-9);
  for (const auto& poses : bounded.poses) {
    for (const JointPositions& pose : poses) {
      EXPECT_LE(std::abs(pose[4]), 3.3);
    }
  }
}

TEST(PlanTour, RefusesMachinesWithoutLimitsAndZonesOutOfReach) {
  Machine machine = example_machine();
  machine.joints[2].limits.max_jerk.reset();
  const std::vector<Stops> zones = ring(2, {0, 1});
  EXPECT_EQ(plan_tour(machine, zones, JointPositions(5, 0)).error().message,
            "machine: joint Z has no max_jerk: speed, acceleration and jerk are needed to time its moves");
  machine = example_machine();
  machine.joints[3].limits.least = -0.1;
  machine.joints[3].limits.most = 0.1;
  const auto error = plan_tour(machine, zones, JointPositions(5, 0)).error();
  EXPECT_EQ(error.code, ErrorCode::out_of_range);
  EXPECT_EQ(error.message.substr(0, 16), "zone 0: layer 0:");
  EXPECT_EQ(plan_tour(machine, {}, JointPositions(5, 0)).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace gravure::zones
