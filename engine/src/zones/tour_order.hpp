#pragma once

#include <cstddef>
#include <vector>

#include "gravure/zones/zone_watch.hpp"

namespace gravure::zones {

/// Times between the ways in which zones can be visited. Way w of zone z is number first[z] + w.
struct TourTimes {
  std::vector<std::size_t> first;              ///< one more than there are zones
  std::vector<double> begin_s;                 ///< from the start to each way's first stop
  std::vector<double> inside_s;                ///< from its first stop to its last
  std::vector<std::vector<double>> between_s;  ///< from the last stop of one way to the first of another

  std::size_t zones() const noexcept { return first.size() - 1; }
};

/// A way for each zone, in the order of visit.
struct TourOrder {
  std::vector<std::size_t> ways;
  double time_s = 0;
  bool is_proved = false;
};

/// The fastest for up to kMostProved zones, else by 2-opt and Or-opt from the nearest neighbour; each zone has one way
/// or more. Some order where `watch` stops.
TourOrder shortest_order(const TourTimes& times, const ZoneWatch& watch = {});
inline constexpr std::size_t kMostProved = 12;

/// The fastest ways for an order of zones.
TourOrder best_ways(const TourTimes& times, const std::vector<std::size_t>& order);

}  // namespace gravure::zones
