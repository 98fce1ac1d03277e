#include "tour_order.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>

namespace gravure::zones {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// A change that gains less is none: rounding must not decide.
constexpr double kGain_s = 1e-9;

/// Shortest time to have visited a set of zones and to stand at the end of a way (Held and Karp).
class SetTimes {
 public:
  explicit SetTimes(const TourTimes& times)
      : times_(times),
        ways_(times.begin_s.size()),
        best_((std::size_t{1} << times.zones()) * ways_, kNever),
        before_(best_.size(), 0) {}

  TourOrder run() {
    const std::size_t zones = times_.zones();
    for (std::size_t z = 0; z < zones; ++z) {
      for (std::size_t w = times_.first[z]; w < times_.first[z + 1]; ++w) {
        best_[place(std::size_t{1} << z, w)] = times_.begin_s[w] + times_.inside_s[w];
      }
    }
    const std::size_t all = (std::size_t{1} << zones) - 1;
    for (std::size_t visited = 1; visited <= all; ++visited) {
      for (std::size_t w = 0; w < ways_; ++w) {
        if (best_[place(visited, w)] < kNever) {
          extend(visited, w);
        }
      }
    }
    return trace_back(all);
  }

 private:
  std::size_t place(std::size_t visited, std::size_t way) const noexcept { return visited * ways_ + way; }

  void extend(std::size_t visited, std::size_t from) {
    const double so_far = best_[place(visited, from)];
    for (std::size_t z = 0; z < times_.zones(); ++z) {
      const std::size_t bit = std::size_t{1} << z;
      for (std::size_t w = times_.first[z]; (visited & bit) == 0 && w < times_.first[z + 1]; ++w) {
        const double time = so_far + times_.between_s[from][w] + times_.inside_s[w];
        if (time < best_[place(visited | bit, w)]) {
          best_[place(visited | bit, w)] = time;
          before_[place(visited | bit, w)] = static_cast<std::uint32_t>(from);
        }
      }
    }
  }

  TourOrder trace_back(std::size_t visited) const {
    std::size_t way = 0;
    for (std::size_t w = 1; w < ways_; ++w) {
      way = best_[place(visited, w)] < best_[place(visited, way)] ? w : way;
    }
    TourOrder order{{}, best_[place(visited, way)], true};
    while (visited != 0) {
      order.ways.push_back(way);
      const std::size_t before = before_[place(visited, way)];
      const auto zone = std::upper_bound(times_.first.begin(), times_.first.end(), way) - times_.first.begin() - 1;
      visited &= ~(std::size_t{1} << static_cast<std::size_t>(zone));
      way = before;
    }
    std::reverse(order.ways.begin(), order.ways.end());
    return order;
  }

  const TourTimes& times_;
  std::size_t ways_;
  std::vector<double> best_;
  std::vector<std::uint32_t> before_;
};

std::vector<std::size_t> nearest_neighbour(const TourTimes& times) {
  std::vector<bool> visited(times.zones(), false);
  std::vector<std::size_t> order;
  std::size_t from = times.begin_s.size();
  for (std::size_t step = 0; step < times.zones(); ++step) {
    std::size_t best_zone = 0;
    std::size_t best_way = 0;
    double least = kNever;
    for (std::size_t z = 0; z < times.zones(); ++z) {
      for (std::size_t w = times.first[z]; !visited[z] && w < times.first[z + 1]; ++w) {
        const double time = step == 0 ? times.begin_s[w] : times.between_s[from][w];
        if (time < least) {
          least = time;
          best_zone = z;
          best_way = w;
        }
      }
    }
    visited[best_zone] = true;
    order.push_back(best_zone);
    from = best_way;
  }
  return order;
}

/// Of zones in the orders that are tried: a hundred zones are improved as far as it goes, a thousand for some seconds.
constexpr std::size_t kMostTourSteps = 100'000'000;

/// Turns round each stretch of the order, and moves each stretch of up to three zones to each other place, while one of
/// these gains.
class Improver {
 public:
  Improver(const TourTimes& times, std::vector<std::size_t> order, const ZoneWatch& watch)
      : times_(times),
        watch_(watch),
        order_(std::move(order)),
        best_(best_ways(times, order_)),
        tries_left_(kMostTourSteps / order_.size()) {}

  TourOrder run() {
    constexpr int kMostSweeps = 50;
    for (int sweep = 0; sweep < kMostSweeps && tries_left_ > 0; ++sweep) {
      const bool turned = turn_stretches();
      if (!move_stretches() && !turned) {
        break;
      }
    }
    return best_;
  }

 private:
  bool accept(const std::vector<std::size_t>& order) {
    tries_left_ = watch_.stopped() ? 0 : tries_left_ - 1;
    TourOrder other = best_ways(times_, order);
    if (!(other.time_s < best_.time_s - kGain_s)) {
      return false;
    }
    best_ = std::move(other);
    order_ = order;
    return true;
  }

  bool turn_stretches() {
    bool gained = false;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      for (std::size_t j = i + 1; j < order_.size() && tries_left_ > 0; ++j) {
        std::vector<std::size_t> order = order_;
        std::reverse(order.begin() + static_cast<std::ptrdiff_t>(i),
                     order.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        gained = accept(order) || gained;
      }
    }
    return gained;
  }

  bool move_stretches() {
    bool gained = false;
    constexpr std::size_t kLongest = 3;
    for (std::size_t length = 1; length <= std::min(kLongest, order_.size() - 1); ++length) {
      for (std::size_t from = 0; from + length <= order_.size(); ++from) {
        for (std::size_t to = 0; to + length <= order_.size() && tries_left_ > 0; ++to) {
          std::vector<std::size_t> order = order_;
          const auto begin = order.begin() + static_cast<std::ptrdiff_t>(from);
          const std::vector<std::size_t> stretch(begin, begin + static_cast<std::ptrdiff_t>(length));
          order.erase(begin, begin + static_cast<std::ptrdiff_t>(length));
          order.insert(order.begin() + static_cast<std::ptrdiff_t>(to), stretch.begin(), stretch.end());
          gained = (to != from && accept(order)) || gained;
        }
      }
    }
    return gained;
  }

  const TourTimes& times_;
  const ZoneWatch& watch_;
  std::vector<std::size_t> order_;
  TourOrder best_;
  std::size_t tries_left_;
};

}  // namespace

TourOrder best_ways(const TourTimes& times, const std::vector<std::size_t>& order) {
  const std::size_t ways = times.begin_s.size();
  std::vector<double> until(ways, kNever);
  std::vector<std::size_t> before(ways, 0);
  for (std::size_t step = 0; step < order.size(); ++step) {
    for (std::size_t w = times.first[order[step]]; w < times.first[order[step] + 1]; ++w) {
      if (step == 0) {
        until[w] = times.begin_s[w] + times.inside_s[w];
        continue;
      }
      const std::size_t last = order[step - 1];
      for (std::size_t b = times.first[last]; b < times.first[last + 1]; ++b) {
        const double time = until[b] + times.between_s[b][w] + times.inside_s[w];
        if (time < until[w]) {
          until[w] = time;
          before[w] = b;
        }
      }
    }
  }
  const std::size_t end = order.back();
  std::size_t way = times.first[end];
  for (std::size_t w = way; w < times.first[end + 1]; ++w) {
    way = until[w] < until[way] ? w : way;
  }
  TourOrder best{{}, until[way], false};
  for (std::size_t step = order.size(); step-- > 0;) {
    best.ways.push_back(way);
    way = before[way];
  }
  std::reverse(best.ways.begin(), best.ways.end());
  return best;
}

TourOrder shortest_order(const TourTimes& times, const ZoneWatch& watch) {
  return times.zones() <= kMostProved ? SetTimes(times).run() : Improver(times, nearest_neighbour(times), watch).run();
}

}  // namespace gravure::zones
