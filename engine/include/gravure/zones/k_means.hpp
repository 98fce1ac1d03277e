#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/progress.hpp"

namespace gravure::zones {

struct KMeansRequest {
  std::size_t clusters = 1;
  std::size_t dimensions = 6;
  std::uint64_t seed = 1;
  int starts = 5;  ///< the one of least inertia is kept, of equals the first
  const CancelToken* cancel = nullptr;
};

struct Clustering {
  std::vector<std::uint32_t> labels;  ///< of each point; clusters are numbered by their first member
  std::vector<double> centres;        ///< cluster by cluster
  double inertia = 0;                 ///< J of [D] eq. 9: squared distances from the own centre, summed
  int rounds = 0;                     ///< of the start that was kept

  std::size_t clusters(std::size_t dimensions) const noexcept { return centres.size() / dimensions; }
};

/// k-means: starts by greedy k-means++ (the best of 2 + ln k draws for each centre) from random_word(), then Lloyd's
/// rounds until no label changes. Of equal distances the lower index wins; a cluster that loses its last member gets
/// the point farthest from its centre. Sums run in the order of the points, so the result is the same bytes on every
/// machine and compiler.
///
/// `points` holds `dimensions` numbers a point. Points of fewer places than `clusters` give one cluster for each place.
/// Fails with out_of_range for a number that is not finite (the point is named), no point, no cluster, or more
/// clusters than points; with cancelled, looked at between rounds.
Result<Clustering> k_means(std::span<const double> points, const KMeansRequest& request);

}  // namespace gravure::zones
