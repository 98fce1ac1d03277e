#include "gravure/texture/decomposition.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dice.hpp"
#include "published_surface.hpp"

namespace gravure::texture {
namespace {

using gravure::test::Dice;

constexpr double kPitch_mm = 40.0 / 255;

/// The sums as they are written, with points beyond the ends made one by one.
std::vector<Vector2> slow_part_by_sums(const std::vector<Vector2>& path, double step_mm, const GaussianFilter& filter) {
  const double sigma = filter.sigma_mm / step_mm;
  const int radius = static_cast<int>(filter.cut * sigma + 0.5);
  const int last = static_cast<int>(path.size()) - 1;
  const auto at = [&](int i) {
    Vector2 shift = Vector2::Zero();
    if (filter.ends == Ends::repeat) {
      return Vector2(path[static_cast<std::size_t>(std::clamp(i, 0, last))]);
    }
    double sign = 1;
    while (i < 0 || i > last) {  // reflected through an end, again and again
      const Vector2 end = i < 0 ? path.front() : path.back();
      shift += sign * 2 * end;
      sign = -sign;
      i = i < 0 ? -i : 2 * last - i;
    }
    return Vector2(shift + sign * path[static_cast<std::size_t>(i)]);
  };
  std::vector<Vector2> slow;
  for (int i = 0; i <= last; ++i) {
    Vector2 sum = Vector2::Zero();
    double weights = 0;
    for (int k = -radius; k <= radius; ++k) {
      const double steps = k;
      const double weight = std::exp(-steps * steps / (2 * sigma * sigma));
      sum += weight * at(i + k);
      weights += weight;
    }
    slow.emplace_back(sum / weights);
  }
  return slow;
}

TEST(SlowPart, IsTheSumOfItsWeights) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<Vector2> path(static_cast<std::size_t>(dice.between(2, 90)));
    for (Vector2& point : path) {
      point = Vector2(static_cast<double>(dice.between(-1000, 1000)), static_cast<double>(dice.between(-1000, 1000)));
    }
    const GaussianFilter filter{.sigma_mm = 0.01 * static_cast<double>(dice.between(1, 900)),
                                .cut = static_cast<double>(dice.between(1, 8)),
                                .ends = dice.coin() ? Ends::odd : Ends::repeat};
    const std::vector<Vector2> slow = slow_part(path, 0.5, filter).value();
    const std::vector<Vector2> sums = slow_part_by_sums(path, 0.5, filter);
    for (std::size_t i = 0; i < path.size(); ++i) {
      ASSERT_LT((slow[i] - sums[i]).norm(), 1e-8)
          << "point " << i << " of " << path.size() << ", sigma " << filter.sigma_mm << ", cut " << filter.cut;
    }
  }
}

/// Weights beyond the ends, which stand for ever, folded into two.
TEST(SlowPart, RepeatsTheEndsHoweverFarTheWeightsReach) {
  const std::vector<Vector2> path = {{1, 2}, {4, -3}, {2, 2}, {7, 0}, {-1, 5}};
  const GaussianFilter filter{.sigma_mm = 9000, .cut = 8, .ends = Ends::repeat};
  const std::vector<Vector2> slow = slow_part(path, 1, filter).value();
  const std::vector<Vector2> sums = slow_part_by_sums(path, 1, filter);
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_LT((slow[i] - sums[i]).norm(), 1e-9) << i;
  }
}

TEST(SlowPart, LeavesStraightPathsAloneEndsIncluded) {
  std::vector<Vector2> path;
  for (int i = 0; i < 300; ++i) {
    path.emplace_back(0.02 * i, 5 - 0.03 * i);
  }
  const std::vector<Vector2> slow = slow_part(path, 0.036, {.sigma_mm = 7.2}).value();
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_LT((slow[i] - path[i]).norm(), 1e-12) << i;
  }
}

/// Exact for a corner of an infinite path: the galvo must reach 2 sin(b / 2) sigma / sqrt(2 pi) at it.
TEST(SlowPart, KeepsTheLawOfCorners) {
  for (const double degrees : {30.0, 90.0, 150.0}) {
    const double turn = degrees * std::numbers::pi / 180;
    std::vector<Vector2> path;
    constexpr int kHalf = 4000;
    for (int i = -kHalf; i <= kHalf; ++i) {
      const double s = 0.005 * std::abs(i);
      path.emplace_back(i < 0 ? Vector2(-s, 0) : Vector2(s * std::cos(turn), s * std::sin(turn)));
    }
    const double sigma_mm = 1.5;
    const std::vector<Vector2> slow = slow_part(path, 0.005, {.sigma_mm = sigma_mm}).value();
    const double throw_mm = (slow[kHalf] - path[kHalf]).norm();
    EXPECT_NEAR(throw_mm, 2 * std::sin(turn / 2) * sigma_mm / std::sqrt(2 * std::numbers::pi), 1e-5) << degrees;
  }
}

TEST(SlowPart, RefusesFiltersThatAreNone) {
  const std::vector<Vector2> path = {{0, 0}, {1, 0}};
  EXPECT_EQ(slow_part(path, 0, {.sigma_mm = 1}).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(slow_part(path, 1, {.sigma_mm = 0}).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(slow_part(path, 1, {.sigma_mm = NAN}).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(slow_part(path, 1e-9, {.sigma_mm = 1e9}).error().code, ErrorCode::out_of_range);
}

/// The published iteration, sigma from 30,000 um by 0.95: a model of the authors' surface, not theirs ([A] 1.4).
TEST(Deviations, AreThePublishedOnesOnTheStatedSurface) {
  struct Row {
    int n;
    double focus_um, incidence_deg, displacement_mm;
  };
  const auto surface = test::published_surface();
  const std::vector<Vector2> path = hilbert_curve(8, 40).value();
  const std::vector<SurfacePoint> targets = test::on(*surface, path);
  for (const Row& row : {Row{0, 216.541, 9.74093, 2.963225}, Row{5, 173.927, 8.71681, 2.658517},
                         Row{10, 133.219, 7.64287, 2.323305}, Row{15, 98.842, 6.57793, 1.994863}}) {
    const double sigma_mm = 30 * std::pow(0.95, row.n);
    const auto slow = slow_part(path, kPitch_mm, {.sigma_mm = sigma_mm, .cut = 4});
    const DeviationSummary most = summarise(targets, test::on(*surface, slow.value()));
    EXPECT_NEAR(most.max_focus_mm * 1000, row.focus_um, 5e-4);
    EXPECT_NEAR(most.max_incidence_rad * 180 / std::numbers::pi, row.incidence_deg, 5e-6);
    EXPECT_NEAR(most.max_displacement_mm, row.displacement_mm, 5e-7);
  }
}

TEST(Deviations, OfPointOneThousandAreThoseOfTheVector) {
  const auto surface = test::published_surface();
  const std::vector<Vector2> path = hilbert_curve(8, 40).value();
  const auto slow = slow_part(path, kPitch_mm, {.sigma_mm = 30 * std::pow(0.95, 15), .cut = 4});
  const SurfacePoint target = test::on(*surface, path)[1000];
  const SurfacePoint stage = test::on(*surface, slow.value())[1000];
  EXPECT_LT((target.position_mm - Vector3(-19.05882353, -15.29411765, -1.88917625)).norm(), 1e-8);
  const Deviation found = deviation(target, stage);
  EXPECT_NEAR(found.focus_mm * 1000, -0.145993, 1e-6);
  EXPECT_NEAR(found.displacement_mm, std::hypot(-0.0107733310, -0.255789285), 1e-9);
}

}  // namespace
}  // namespace gravure::texture
