#include <algorithm>
#include <cmath>
#include <utility>

#include "zone_of.hpp"

namespace gravure::zones {
namespace {

double squared_angles(const std::vector<Piece>& pieces, const Zone& zone) noexcept {
  double sum = 0;
  for (const std::size_t i : zone.pieces) {
    const double angle = angle_between(pieces[i].direction, zone.direction);
    sum += angle * angle;
  }
  return sum;
}

/// Pieces looked at for moves, with repetition: what is left of thousands stays where the cover has put it.
constexpr std::size_t kMostMoveLooks = 20'000'000;

class Refiner {
 public:
  Refiner(const std::vector<Piece>& pieces, const ZoneLimits& limits, const ZoneWatch& watch, std::vector<Zone>& zones)
      : pieces_(pieces), limits_(limits), watch_(watch), zones_(zones), home_(pieces.size()) {
    for (std::size_t z = 0; z < zones.size(); ++z) {
      costs_.push_back(squared_angles(pieces, zones[z]));
      for (const std::size_t i : zones[z].pieces) {
        home_[i] = z;
      }
    }
  }

  /// Once through all pieces; did one move?
  bool sweep() {
    bool moved = false;
    for (std::size_t i = 0; i < pieces_.size() && !watch_.stopped(); ++i) {
      watch_.tell(ZonePart::refine, kMostMoveLooks - looks_left_, kMostMoveLooks);
      moved = move(i) || moved;
    }
    return moved;
  }

 private:
  /// To the nearest zone that can take it.
  bool move(std::size_t piece) {
    const Vector3& direction = pieces_[piece].direction;
    const double here = angle_between(direction, zones_[home_[piece]].direction);
    std::vector<std::pair<double, std::size_t>> nearer;
    for (std::size_t z = 0; z < zones_.size(); ++z) {
      const double angle = angle_between(direction, zones_[z].direction);
      if (z != home_[piece] && angle < here) {
        nearer.emplace_back(angle, z);
      }
    }
    std::sort(nearer.begin(), nearer.end());
    return std::any_of(nearer.begin(), nearer.end(), [&](const auto& to) { return try_move(piece, to.second); });
  }

  bool try_move(std::size_t piece, std::size_t to) {
    constexpr double kGain = 1e-12;
    const std::size_t from = home_[piece];
    std::vector<std::size_t> grown = zones_[to].pieces;
    grown.insert(std::upper_bound(grown.begin(), grown.end(), piece), piece);
    std::vector<std::size_t> left = zones_[from].pieces;
    left.erase(std::find(left.begin(), left.end(), piece));
    if (left.empty() || grown.size() + left.size() > looks_left_) {
      return false;
    }
    looks_left_ -= grown.size() + left.size();
    const std::optional<Zone> new_to = zone_of(pieces_, grown, limits_, zones_[to].direction);
    const std::optional<Zone> new_from = zone_of(pieces_, left, limits_, zones_[from].direction);
    if (!new_to || !new_from) {
      return false;
    }
    const double cost_to = squared_angles(pieces_, *new_to);
    const double cost_from = squared_angles(pieces_, *new_from);
    if (cost_to + cost_from + kGain >= costs_[to] + costs_[from]) {
      return false;
    }
    costs_[to] = cost_to;
    costs_[from] = cost_from;
    zones_[to] = *new_to;
    zones_[from] = *new_from;
    home_[piece] = to;
    return true;
  }

  const std::vector<Piece>& pieces_;
  const ZoneLimits& limits_;
  const ZoneWatch& watch_;
  std::vector<Zone>& zones_;
  std::vector<std::size_t> home_;
  std::vector<double> costs_;  ///< squared angles of each zone
  std::size_t looks_left_ = kMostMoveLooks;
};

}  // namespace

void refine_zones(const std::vector<Piece>& pieces, const ZoneLimits& limits, const ZoneWatch& watch,
                  std::vector<Zone>& zones) {
  constexpr int kMostSweeps = 100;
  Refiner refiner(pieces, limits, watch, zones);
  for (int sweep = 0; sweep < kMostSweeps && refiner.sweep(); ++sweep) {
  }
}

}  // namespace gravure::zones
