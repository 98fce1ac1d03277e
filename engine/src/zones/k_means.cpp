#include "gravure/zones/k_means.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "gravure/zones/counter_random.hpp"

namespace gravure::zones {
namespace {

/// Centres whose distances are taken at once.
constexpr std::size_t kBlock = 8;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr int kMostRounds = 10'000;  // rounding could make two labels change for ever

struct Data {
  const double* points;
  std::size_t count;
  std::size_t dimensions;
  const double* at(std::size_t i) const { return points + i * dimensions; }
};

double squared_distance(const double* a, const double* b, std::size_t dimensions) noexcept {
  double sum = 0;
  for (std::size_t d = 0; d < dimensions; ++d) {
    const double difference = a[d] - b[d];
    sum += difference * difference;
  }
  return sum;
}

/// Centres in blocks of kBlock, dimension by dimension, so that the distances of a block are one vector operation each.
/// What is left over in the last block is infinitely far.
class Blocks {
 public:
  explicit Blocks(const Data& data) : dimensions_(data.dimensions) {}

  void set(const std::vector<double>& centres) {
    const std::size_t count = centres.size() / dimensions_;
    blocks_ = (count + kBlock - 1) / kBlock;
    values_.assign(blocks_ * kBlock * dimensions_, std::numeric_limits<double>::infinity());
    for (std::size_t c = 0; c < count; ++c) {
      for (std::size_t d = 0; d < dimensions_; ++d) {
        values_[((c / kBlock) * dimensions_ + d) * kBlock + c % kBlock] = centres[c * dimensions_ + d];
      }
    }
  }

  struct Nearest {
    std::uint32_t centre = 0;
    double squared = std::numeric_limits<double>::infinity();
    double next_squared = std::numeric_limits<double>::infinity();  ///< of the nearest other centre
  };
  Nearest nearest(const double* point) const noexcept {
    Nearest best;
    for (std::size_t b = 0; b < blocks_; ++b) {
      std::array<double, kBlock> squared{};
      const double* const block = values_.data() + b * dimensions_ * kBlock;
      for (std::size_t d = 0; d < dimensions_; ++d) {
        for (std::size_t c = 0; c < kBlock; ++c) {
          const double difference = point[d] - block[d * kBlock + c];
          squared[c] += difference * difference;
        }
      }
      for (std::size_t c = 0; c < kBlock; ++c) {
        if (squared[c] < best.squared) {
          best = {static_cast<std::uint32_t>(b * kBlock + c), squared[c], best.squared};
        } else {
          best.next_squared = std::min(best.next_squared, squared[c]);
        }
      }
    }
    return best;
  }

 private:
  std::size_t dimensions_;
  std::size_t blocks_ = 0;
  std::vector<double> values_;
};

void append(std::vector<double>& centres, const Data& data, std::size_t point) {
  centres.insert(centres.end(), data.at(point), data.at(point) + data.dimensions);
}

/// A point drawn by its squared distance from the centres so far. Rounding may leave the draw at the sum: then it is
/// the last point that is no centre yet.
std::size_t draw_point(const std::vector<double>& squared, double drawn) {
  std::size_t last = 0;
  double before = 0;
  for (std::size_t i = 0; i < squared.size(); ++i) {
    before += squared[i];
    last = squared[i] > 0 ? i : last;
    if (before > drawn) {
      return i;
    }
  }
  return last;
}

/// The squared distances once `point` is a centre as well; returns their sum.
double with_centre(const Data& data, std::size_t point, const std::vector<double>& squared, std::vector<double>& then) {
  double sum = 0;
  for (std::size_t i = 0; i < data.count; ++i) {
    then[i] = std::min(squared[i], squared_distance(data.at(i), data.at(point), data.dimensions));
    sum += then[i];
  }
  return sum;
}

bool is_stopped(const KMeansRequest& request) {
  return request.cancel != nullptr && request.cancel->cancelled();
}

/// k-means++: each centre a point, drawn by its squared distance from those before; of 2 + ln k draws the one that
/// leaves least is taken. Fewer centres where no other place is left.
std::vector<double> first_centres(const Data& data, const KMeansRequest& request, std::uint64_t start) {
  const int draws = 2 + static_cast<int>(std::log(static_cast<double>(request.clusters)));
  std::vector<double> centres;
  std::uint64_t counter = 0;
  const std::size_t first = random_word(request.seed, start, counter++) % data.count;
  append(centres, data, first);
  std::vector<double> squared(data.count, std::numeric_limits<double>::infinity());
  double sum = with_centre(data, first, squared, squared);
  std::vector<double> then(data.count);
  std::vector<double> best(data.count);
  for (std::size_t c = 1; c < request.clusters && sum > 0 && !is_stopped(request); ++c) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t chosen = 0;
    for (int draw = 0; draw < draws; ++draw) {
      const std::size_t point = draw_point(squared, random_fraction(request.seed, start, counter++) * sum);
      const double left = with_centre(data, point, squared, then);
      if (left < least) {
        least = left;
        chosen = point;
        std::swap(best, then);
      }
    }
    append(centres, data, chosen);
    std::swap(squared, best);
    sum = least;
  }
  return centres;
}

struct State {
  std::vector<double> centres;
  std::vector<std::uint32_t> labels;
  /// Of each point: no further from the centre of its label than the one, no nearer to any other than the other
  /// (Hamerly 2010). While they are apart, the label stays, and nothing needs to be measured.
  std::vector<double> farthest_own;
  std::vector<double> nearest_other;
};

/// Bounds differ by more than all roundings of measured distances: labels are those of measuring every distance.
constexpr double kBoundSlack = 1e-9;

/// Each point to its nearest centre; did a label change?
bool assign(const Data& data, Blocks& blocks, State& state) {
  blocks.set(state.centres);
  bool changed = false;
  for (std::size_t i = 0; i < data.count; ++i) {
    if (state.farthest_own[i] * (1 + kBoundSlack) < state.nearest_other[i]) {
      continue;
    }
    const Blocks::Nearest nearest = blocks.nearest(data.at(i));
    changed = changed || nearest.centre != state.labels[i];
    state.labels[i] = nearest.centre;
    state.farthest_own[i] = std::sqrt(nearest.squared);
    state.nearest_other[i] = std::sqrt(nearest.next_squared);
  }
  return changed;
}

std::vector<std::size_t> sizes_of(const State& state, std::size_t clusters) {
  std::vector<std::size_t> sizes(clusters);
  for (const std::uint32_t label : state.labels) {
    ++sizes[label];
  }
  return sizes;
}

/// Squared distance of each point from the centre of its label.
std::vector<double> squared_distances(const Data& data, const State& state) {
  std::vector<double> squared(data.count);
  for (std::size_t i = 0; i < data.count; ++i) {
    squared[i] =
        squared_distance(data.at(i), state.centres.data() + state.labels[i] * data.dimensions, data.dimensions);
  }
  return squared;
}

/// The point farthest from its centre, of clusters that have others, becomes the only member of a cluster without any.
void fill_empty(const Data& data, State& state, std::size_t clusters) {
  std::vector<std::size_t> sizes = sizes_of(state, clusters);
  if (std::find(sizes.begin(), sizes.end(), std::size_t{0}) == sizes.end()) {
    return;
  }
  std::vector<double> squared = squared_distances(data, state);
  for (std::uint32_t c = 0; c < clusters; ++c) {
    if (sizes[c] > 0) {
      continue;
    }
    std::size_t farthest = state.labels.size();
    for (std::size_t i = 0; i < state.labels.size(); ++i) {
      if (sizes[state.labels[i]] > 1 && (farthest == state.labels.size() || squared[i] > squared[farthest])) {
        farthest = i;
      }
    }
    --sizes[state.labels[farthest]];
    sizes[c] = 1;
    state.labels[farthest] = c;
    state.nearest_other[farthest] = 0;  // to be measured again
    squared[farthest] = 0;
  }
}

/// Centres moved: the bounds widen by as much.
void widen_bounds(const Data& data, const std::vector<double>& before, State& state) {
  std::vector<double> ways;
  for (std::size_t at = 0; at < before.size(); at += data.dimensions) {
    ways.push_back(std::sqrt(squared_distance(before.data() + at, state.centres.data() + at, data.dimensions)));
  }
  const double longest = *std::max_element(ways.begin(), ways.end());
  for (std::size_t i = 0; i < data.count; ++i) {
    state.farthest_own[i] += ways[state.labels[i]];
    state.nearest_other[i] -= longest;
  }
}

/// Each to the mean of its members.
void move_centres(const Data& data, State& state) {
  const std::vector<double> before = state.centres;
  const std::size_t clusters = state.centres.size() / data.dimensions;
  const std::vector<std::size_t> sizes = sizes_of(state, clusters);
  std::fill(state.centres.begin(), state.centres.end(), 0.0);
  for (std::size_t i = 0; i < data.count; ++i) {
    double* const centre = state.centres.data() + state.labels[i] * data.dimensions;
    for (std::size_t d = 0; d < data.dimensions; ++d) {
      centre[d] += data.at(i)[d];
    }
  }
  for (std::size_t c = 0; c < clusters; ++c) {
    for (std::size_t d = 0; d < data.dimensions; ++d) {
      state.centres[c * data.dimensions + d] /= static_cast<double>(sizes[c]);
    }
  }
  widen_bounds(data, before, state);
}

Clustering cluster_once(const Data& data, const KMeansRequest& request, std::uint64_t start) {
  State state;
  state.centres = first_centres(data, request, start);
  const std::size_t clusters = state.centres.size() / data.dimensions;
  state.labels.assign(data.count, kNone);
  state.farthest_own.assign(data.count, 0);
  state.nearest_other.assign(data.count, 0);
  Blocks blocks(data);
  int rounds = 0;
  while (rounds < kMostRounds && !is_stopped(request) && assign(data, blocks, state)) {
    fill_empty(data, state, clusters);
    move_centres(data, state);
    ++rounds;
  }
  Clustering result;
  if (is_stopped(request)) {
    return result;  // some points may have no label yet
  }
  result.labels = std::move(state.labels);
  result.centres = std::move(state.centres);
  result.rounds = rounds;
  for (std::size_t i = 0; i < data.count; ++i) {
    result.inertia +=
        squared_distance(data.at(i), result.centres.data() + result.labels[i] * data.dimensions, data.dimensions);
  }
  return result;
}

/// Clusters in the order of their first members; one without members, which rounding can leave, goes.
void renumber(Clustering& result, std::size_t dimensions) {
  std::vector<std::uint32_t> names(result.centres.size() / dimensions, kNone);
  std::vector<double> centres;
  std::uint32_t next = 0;
  for (std::uint32_t& label : result.labels) {
    if (names[label] == kNone) {
      names[label] = next++;
      const double* const centre = result.centres.data() + label * dimensions;
      centres.insert(centres.end(), centre, centre + dimensions);
    }
    label = names[label];
  }
  result.centres = std::move(centres);
}

Result<void> check(std::span<const double> points, const KMeansRequest& request) {
  const auto refuse = [](std::string message) { return Error{ErrorCode::out_of_range, std::move(message)}; };
  if (request.dimensions == 0 || points.empty() || points.size() % request.dimensions != 0) {
    return refuse(fmt::format("k-means: {} numbers are no points of {} dimensions", points.size(), request.dimensions));
  }
  const std::size_t count = points.size() / request.dimensions;
  if (request.clusters == 0 || request.clusters > count || count >= kNone) {
    return refuse(fmt::format("k-means: {} clusters of {} points: must be from 1 to the number of points",
                              request.clusters, count));
  }
  if (request.starts < 1) {
    return refuse(fmt::format("k-means: {} starts: must be 1 or more", request.starts));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i])) {
      return refuse(fmt::format("k-means: point {}, number {} = {}: must be finite", i / request.dimensions,
                                i % request.dimensions, points[i]));
    }
  }
  return {};
}

}  // namespace

Result<Clustering> k_means(std::span<const double> points, const KMeansRequest& request) {
  GRAVURE_CHECK(check(points, request));
  const Data data{points.data(), points.size() / request.dimensions, request.dimensions};
  Clustering best = cluster_once(data, request, 0);
  for (int start = 1; start < request.starts && !is_stopped(request); ++start) {
    Clustering other = cluster_once(data, request, static_cast<std::uint64_t>(start));
    if (other.inertia < best.inertia) {
      best = std::move(other);
    }
  }
  if (is_stopped(request)) {
    return Error{ErrorCode::cancelled, "stopped before k-means was done"};
  }
  renumber(best, request.dimensions);
  return best;
}

}  // namespace gravure::zones
