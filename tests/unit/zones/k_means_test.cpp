#include "gravure/zones/k_means.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "dice.hpp"
#include "gravure/zones/counter_random.hpp"

namespace gravure::zones {
namespace {

std::vector<double> random_points(test::Dice& dice, std::size_t count, std::size_t dimensions) {
  std::vector<double> points(count * dimensions);
  for (double& value : points) {
    value = static_cast<double>(dice.between(0, 1'000'000)) / 1'000'000;
  }
  return points;
}

double inertia_of(const std::vector<double>& points, const Clustering& clusters, std::size_t dimensions) {
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double off = points[i] - clusters.centres[clusters.labels[i / dimensions] * dimensions + i % dimensions];
    sum += off * off;
  }
  return sum;
}

TEST(CounterRandom, IsSplitMix64) {
  // SplitMix64 started at 0 gives these words; seed and stream 0 mix to 0.
  EXPECT_EQ(random_word(0, 0, 0), 0xE220A8397B1DCDAFU);
  EXPECT_EQ(random_word(0, 0, 1), 0x6E789E6AA1B965F4U);
  EXPECT_NE(random_word(0, 1, 0), random_word(1, 0, 0));
}

TEST(KMeans, FindsTheBestOfAllLabellingsOnSmallCases) {
  SCOPED_TRACE(test::Dice::note());
  test::Dice dice(21);
  int best_of_all = 0;
  constexpr int kCases = 100;
  for (int trial = 0; trial < kCases; ++trial) {
    const std::vector<double> points = random_points(dice, 9, 2);
    KMeansRequest request{3, 2, 1, 5};
    const Clustering found = k_means(points, request).value();
    double least = std::numeric_limits<double>::infinity();
    for (int code = 0; code < 19683; ++code) {  // 3^9 labellings
      Clustering other{std::vector<std::uint32_t>(9), std::vector<double>(6), 0, 0};
      double sizes[3] = {0, 0, 0};
      for (std::size_t i = 0, rest = static_cast<std::size_t>(code); i < 9; ++i, rest /= 3) {
        const auto label = static_cast<std::uint32_t>(rest % 3);
        other.labels[i] = label;
        sizes[label] += 1;
        other.centres[label * 2] += points[i * 2];
        other.centres[label * 2 + 1] += points[i * 2 + 1];
      }
      for (std::size_t c = 0; c < 6; ++c) {
        other.centres[c] /= std::max(1.0, sizes[c / 2]);
      }
      least = std::min(least, inertia_of(points, other, 2));
    }
    EXPECT_GE(found.inertia, least - 1e-12);
    best_of_all += found.inertia <= least + 1e-12 ? 1 : 0;
  }
  EXPECT_GE(best_of_all, kCases * 8 / 10) << "a local search need not find the best each time";
}

TEST(KMeans, EndsWhereNoPointIsNearerToAnotherCentre) {
  SCOPED_TRACE(test::Dice::note());
  test::Dice dice(22);
  for (const std::size_t clusters : {1U, 7U, 8U, 9U, 31U}) {
    const std::vector<double> points = random_points(dice, 500, 6);
    const Clustering found = k_means(points, {clusters, 6, 3, 2}).value();
    ASSERT_EQ(found.clusters(6), clusters);
    EXPECT_NEAR(found.inertia, inertia_of(points, found, 6), 1e-9);
    std::vector<double> sizes(clusters);
    std::vector<double> centres(clusters * 6);
    for (std::size_t i = 0; i < 500; ++i) {
      sizes[found.labels[i]] += 1;
      double own = 0;
      std::vector<double> others(clusters);
      for (std::size_t c = 0; c < clusters; ++c) {
        for (std::size_t d = 0; d < 6; ++d) {
          others[c] += std::pow(points[i * 6 + d] - found.centres[c * 6 + d], 2);
        }
      }
      own = others[found.labels[i]];
      for (const double other : others) {
        ASSERT_LE(own, other + 1e-15);
      }
      for (std::size_t d = 0; d < 6; ++d) {
        centres[found.labels[i] * 6 + d] += points[i * 6 + d];
      }
    }
    for (std::size_t c = 0; c < centres.size(); ++c) {
      EXPECT_NEAR(found.centres[c], centres[c] / sizes[c / 6], 1e-12);
    }
  }
}

/// The middle point is as far from both ends: it goes to the end that was drawn first, and of starts that leave the
/// same the first is kept.
TEST(KMeans, GivesTiesToTheLowerIndex) {
  const std::vector<double> points{0, 0, 0, 1, 2, 2, 2};
  int seen = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const std::size_t first = random_word(seed, 0, 0) % points.size();
    if (points[first] == 1) {
      continue;  // a centre of its own
    }
    const bool from_left = points[first] == 0;
    for (const int starts : {1, 5}) {
      const Clustering found = k_means(points, {2, 1, seed, starts}).value();
      ASSERT_EQ(found.inertia, 0.75) << seed;
      EXPECT_EQ(found.labels[3], from_left ? 0U : 1U) << seed << ", " << starts << " starts";
    }
    seen |= from_left ? 1 : 2;
  }
  EXPECT_EQ(seen, 3);
}

TEST(KMeans, NumbersClustersByTheirFirstMembers) {
  const std::vector<double> points{9, 9.1, 0, 0.1, 5, 5.1};
  const Clustering found = k_means(points, {3, 1, 1, 5}).value();
  EXPECT_EQ(found.labels, (std::vector<std::uint32_t>{0, 0, 1, 1, 2, 2}));
}

TEST(KMeans, GivesOneClusterForEachPlaceWhereThereAreFewer) {
  std::vector<double> points;
  for (int i = 0; i < 30; ++i) {
    points.push_back(i % 3);
  }
  const Clustering found = k_means(points, {8, 1, 1, 5}).value();
  EXPECT_EQ(found.clusters(1), 3U);
  EXPECT_EQ(found.inertia, 0);
  const Clustering one = k_means(std::vector<double>(60, 0.25), {8, 6, 1, 5}).value();
  EXPECT_EQ(one.clusters(6), 1U);
}

/// What came out when this was written, on both compilers: bytes do not change unseen.
TEST(KMeans, GivesTheSameBytesEverywhere) {
  std::vector<double> points(6 * 300);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = random_fraction(7, 0, i);
  }
  const Clustering found = k_means(points, {10, 6, 1, 5}).value();
  std::uint64_t sum = 0;
  for (const double centre : found.centres) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &centre, sizeof(bits));
    sum = (sum ^ bits) * 0x100000001B3U;
  }
  for (const std::uint32_t label : found.labels) {
    sum = (sum ^ label) * 0x100000001B3U;
  }
  EXPECT_EQ(sum, 1356503633462358904U);
  const Clustering again = k_means(points, {10, 6, 1, 5}).value();
  EXPECT_EQ(found.labels, again.labels);
  EXPECT_EQ(found.centres, again.centres);
}

TEST(KMeans, RefusesByName) {
  const std::vector<double> points{0, 1, 2, std::nan(""), 4, 5};
  EXPECT_EQ(k_means(points, {1, 2, 1, 1}).error().message, "k-means: point 1, number 1 = nan: must be finite");
  EXPECT_EQ(k_means(std::vector<double>{1, 2}, {3, 1, 1, 1}).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(k_means(std::vector<double>{1, 2}, {0, 1, 1, 1}).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(k_means({}, {1, 1, 1, 1}).error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace gravure::zones
