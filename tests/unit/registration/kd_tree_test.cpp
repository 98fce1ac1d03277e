#include "kd_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "morton.hpp"
#include "registration_test_support.hpp"

namespace gravure::registration {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

constexpr double kAnywhere = std::numeric_limits<double>::max();

/// Many at the same places, so that distances are often equal.
Vectors places(std::size_t count, Dice& dice) {
  Vectors all;
  for (std::size_t i = 0; i < count; ++i) {
    all.emplace_back(static_cast<double>(dice.between(0, 5)), static_cast<double>(dice.between(0, 5)),
                     static_cast<double>(dice.between(0, 3)));
  }
  return all;
}

TEST(KdTree, FindsWhatLookingAtAllFindsTheLowestNumberFirst) {
  GRAVURE_TRACE_DICE();
  Dice dice;
  for (const std::size_t count : {1U, 2U, 17U, 700U}) {
    const Vectors points = places(count, dice);
    const KdTree tree(points);
    std::vector<Neighbour> few;
    for (const Eigen::Vector3d& asked : places(100, dice)) {
      std::vector<std::pair<double, std::ptrdiff_t>> all;
      for (std::size_t i = 0; i < count; ++i) {
        all.emplace_back((points[i] - asked).squaredNorm(), static_cast<std::ptrdiff_t>(i));
      }
      std::sort(all.begin(), all.end());
      EXPECT_EQ(tree.nearest(asked, kAnywhere).index, all[0].second);
      tree.nearest(asked, kAnywhere, 5, few);
      ASSERT_EQ(few.size(), std::min<std::size_t>(5, count));
      for (std::size_t i = 0; i < few.size(); ++i) {
        EXPECT_EQ(few[i].index, all[i].second);
        EXPECT_EQ(few[i].distance2, all[i].first);
      }
      std::vector<std::size_t> near;
      tree.within(asked, 1, near);
      EXPECT_EQ(static_cast<std::ptrdiff_t>(near.size()),
                std::count_if(all.begin(), all.end(), [](const auto& one) { return one.first <= 1; }));
    }
  }
}

TEST(KdTree, HasNoneForWhatIsNotFiniteOrTooFar) {
  const Vectors points{{0, 0, 0}, {1, 0, 0}};
  const KdTree tree(points);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Neighbour> few;
  EXPECT_EQ(tree.nearest({nan, 0, 0}, kAnywhere).index, -1);
  EXPECT_EQ(tree.nearest({0, kAnywhere * 2, 0}, kAnywhere).index, -1);
  tree.nearest({0, nan, 0}, kAnywhere, 2, few);
  EXPECT_TRUE(few.empty());
  EXPECT_EQ(tree.nearest({3, 0, 0}, 1.99).index, -1);
  EXPECT_EQ(tree.nearest({3, 0, 0}, 2).index, 1);  // on the radius
}

TEST(MortonOrder, NamesEveryPointOnceAndKeepsNeighboursTogether) {
  GRAVURE_TRACE_DICE();
  Dice dice(1);
  Vectors points;
  for (int i = 0; i < 4096; ++i) {
    points.emplace_back(BladeSurface::unit(dice), BladeSurface::unit(dice), BladeSurface::unit(dice));
  }
  const std::vector<std::uint32_t> order = morton_order(points);
  std::vector<std::uint32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  double as_given = 0;
  double ordered = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    ASSERT_EQ(sorted[i], i);
    as_given += i > 0 ? (points[i] - points[i - 1]).norm() : 0;
    ordered += i > 0 ? (points[order[i]] - points[order[i - 1]]).norm() : 0;
  }
  EXPECT_LT(ordered, 0.2 * as_given);
  EXPECT_EQ(morton_order({{1, 1, 1}, {1, 1, 1}}), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_TRUE(morton_order({}).empty());
}

}  // namespace
}  // namespace gravure::registration
