#include "gravure/motion/unreverse.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "motion_test_support.hpp"

namespace gravure::motion {
namespace {

struct Path {
  std::vector<double> s;
  std::vector<double> angle;
};

/// 475 samples with four stretches that run backwards.
Path published_style_path() {
  Path path;
  for (int k = 0; k < 475; ++k) {
    const double s = k / 474.0;
    path.s.push_back(s);
    path.angle.push_back(10 + 30 * s + 1.6 * std::sin(8 * std::acos(-1.0) * s));
  }
  return path;
}

TEST(MonotoneFit, GivesTheVectorsOfFourAndSixteenControlPoints) {
  const Path path = published_style_path();
  const MonotoneFit four = fit_monotone({path.s, path.angle, 4, 1}).value();
  const double expected[] = {11.163579, 17.757562, 32.242438, 38.836421};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(four.spline.control_points[i], expected[i], 5e-7);
  }
  EXPECT_NEAR(four.rms, 1.067251, 5e-7);
  EXPECT_NEAR(four.largest, 1.799351, 5e-7);
  const MonotoneFit sixteen = fit_monotone({path.s, path.angle, 16, 1}).value();
  EXPECT_NEAR(sixteen.rms, 0.299333, 5e-7);
  EXPECT_NEAR(sixteen.largest, 0.509663, 5e-7);
  for (const double points : {4, 16}) {
    const auto fit = fit_monotone({path.s, path.angle, static_cast<std::size_t>(points), 1}).value();
    std::vector<double> values;
    for (const double s : path.s) {
      values.push_back(fit.spline.at(s));
    }
    EXPECT_EQ(count_reversals(values), 0U);
  }
}

/// Projected coordinate descent on c0 and non-negative differences: slow, simple, and nothing in common with the
/// solver.
std::vector<double> slow_monotone(const MonotoneFitRequest& r) {
  const std::size_t n = r.control_points;
  std::vector<std::vector<double>> columns(n, std::vector<double>(r.value.size()));
  for (std::size_t j = 0; j < n; ++j) {
    CubicSpline unit{r.parameter.front(), r.parameter.back(), std::vector<double>(n, 0)};
    for (std::size_t i = j; i < n; ++i) {
      unit.control_points[i] = 1;
    }
    for (std::size_t k = 0; k < r.value.size(); ++k) {
      columns[j][k] = unit.at(r.parameter[k]);
    }
  }
  std::vector<double> d(n, 0);
  std::vector<double> error(r.value.begin(), r.value.end());
  for (int round = 0; round < 20000; ++round) {
    for (std::size_t j = 0; j < n; ++j) {
      double up = 0;
      double down = 0;
      for (std::size_t k = 0; k < error.size(); ++k) {
        up += columns[j][k] * error[k];
        down += columns[j][k] * columns[j][k];
      }
      const double next = j == 0 ? d[j] + up / down : std::max(0.0, d[j] + up / down);
      for (std::size_t k = 0; k < error.size(); ++k) {
        error[k] -= (next - d[j]) * columns[j][k];
      }
      d[j] = next;
    }
  }
  std::vector<double> c(n);
  double sum = 0;
  for (std::size_t j = 0; j < n; ++j) {
    c[j] = sum += d[j];
  }
  return c;
}

TEST(MonotoneFit, IsTheConstrainedOptimumOfASlowSolver) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  for (int trial = 0; trial < 10; ++trial) {
    Path path;
    double walk = 0;
    for (int k = 0; k < 60; ++k) {
      path.s.push_back(k + 0.3 * random.uniform());
      walk += random.between(-1, 1.2);
      path.angle.push_back(walk);
    }
    const MonotoneFitRequest request{path.s, path.angle, 9, 1};
    ASSERT_TRUE(fit_monotone(request).value().optimal);
    const auto fast = fit_monotone(request).value().spline.control_points;
    const auto slow = slow_monotone(request);
    for (std::size_t i = 0; i < fast.size(); ++i) {
      EXPECT_NEAR(fast[i], slow[i], 1e-5) << "trial " << trial << " point " << i;
    }
  }
}

TEST(MonotoneFit, NeverRunsBackwardsOnNoisyPathsOfAnySize) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  for (const auto& [samples, points] :
       {std::pair(2000, 100), std::pair(10000, 500), std::pair(100000, 2000), std::pair(50, 400)}) {
    Path path;
    for (int k = 0; k < samples; ++k) {
      const double s = static_cast<double>(k) / samples;
      path.s.push_back(s);
      path.angle.push_back(-(3 * s + 0.4 * std::sin(9 * s)) + 0.004 * random.gaussian());
    }
    for (const SplineEnd end : {SplineEnd::free, SplineEnd::anchored, SplineEnd::resting}) {
      const auto fit = fit_monotone({path.s, path.angle, static_cast<std::size_t>(points), -1, end, end});
      ASSERT_TRUE(fit) << fit.error().message;
      std::vector<double> values;
      const auto& c = fit.value().spline.control_points;
      for (std::size_t i = 1; i < c.size(); ++i) {
        ASSERT_LE(c[i], c[i - 1]);
      }
      for (int k = 0; k < 20000; ++k) {
        values.push_back(fit.value().spline.at(path.s.back() * k / 19999));
      }
      for (std::size_t k = 1; k < values.size(); ++k) {
        ASSERT_LE(values[k], values[k - 1] + 1e-14);
      }
      EXPECT_TRUE(fit.value().optimal || samples < points);
      EXPECT_LT(fit.value().rms, samples < 100 ? 0.05 : 0.02);
    }
  }
}

TEST(MonotoneFit, StaysMonotoneWhereControlPointsOutnumberSamples) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed() + 5);
  for (int trial = 0; trial < 200; ++trial) {
    Path path;
    double walk = 0;
    for (int k = 0; k < 8 + trial % 40; ++k) {
      path.s.push_back(k + (k % 5 == 0 ? 0.7 * random.uniform() : 0.0));
      walk += random.between(-1, 1.4);
      path.angle.push_back(walk);
    }
    path.angle.back() = std::max(path.angle.back(), path.angle.front() + 1);
    const auto fit = fit_monotone(
        {path.s, path.angle, static_cast<std::size_t>(32 << trial % 6), 1, SplineEnd::resting, SplineEnd::anchored});
    ASSERT_TRUE(fit) << fit.error().message;
    const auto& c = fit.value().spline.control_points;
    for (std::size_t i = 1; i < c.size(); ++i) {
      ASSERT_GE(c[i], c[i - 1]);
    }
    EXPECT_EQ(fit.value().spline.at(path.s.front()), path.angle.front());
    EXPECT_LT(fit.value().rms, 4) << trial;  // the walks turn back by up to this much
  }
}

TEST(MonotoneFit, RefusesWhatItCannotFit) {
  const std::vector<double> s{0, 1, 2, 3, 4};
  const std::vector<double> a{0, 1, 2, 3, 4};
  EXPECT_FALSE(fit_monotone({s, a, 3, 1}));
  EXPECT_FALSE(fit_monotone({s, a, 5, 1, SplineEnd::resting, SplineEnd::resting}));
  EXPECT_FALSE(fit_monotone({s, std::span(a).first(4), 4, 1}));
  EXPECT_FALSE(fit_monotone({s, a, 4, -1, SplineEnd::anchored, SplineEnd::anchored}));
  const std::vector<double> stalls{0, 1, 1, 3, 4};
  EXPECT_EQ(fit_monotone({stalls, a, 4, 1}).error().code, ErrorCode::bad_argument);
}

TEST(RemoveReversals, KeepsIntendedTurnsAndBoundsTheDeviation) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  Path path;
  for (int k = 0; k < 3000; ++k) {
    path.s.push_back(0.1 * k);
    path.angle.push_back(20 * std::sin(k / 250.0) + 0.05 * random.gaussian());
  }
  const Unreversed result = remove_reversals({path.s, path.angle, 1.0, 16}).value();
  EXPECT_GT(result.reversals_before, 1000U);
  EXPECT_EQ(result.reversals_after, 4U);  // 12 rad: quarters at pi/2, 3 pi/2, 5 pi/2, 7 pi/2
  EXPECT_EQ(result.turns.size(), 6U);
  EXPECT_LE(result.largest_deviation, 1.0);
  EXPECT_EQ(result.angle.front(), path.angle.front());
  EXPECT_EQ(result.angle.back(), path.angle.back());
}

TEST(RemoveReversals, JoinsPiecesWithoutSpeedOrAcceleration) {
  const Path up_down = [] {
    Path path;
    for (int k = 0; k <= 400; ++k) {
      path.s.push_back(k);
      path.angle.push_back(k < 200 ? k * 0.1 : 40 - k * 0.1);
    }
    return path;
  }();
  const Unreversed result = remove_reversals({up_down.s, up_down.angle, 0.5, 16}).value();
  ASSERT_EQ(result.pieces.size(), 2U);
  const double h = 1e-3;
  const double turn = result.pieces[0].at(200);
  EXPECT_NEAR(turn, 20, 1e-12);
  EXPECT_NEAR(result.pieces[1].at(200), turn, 1e-12);
  EXPECT_NEAR((turn - result.pieces[0].at(200 - h)) / h, 0, 1e-6);
  EXPECT_NEAR((result.pieces[1].at(200 + h) - turn) / h, 0, 1e-6);
  EXPECT_LE(result.largest_deviation, 0.5);
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, std::abs(a[k] - b[k]));
  }
  return largest;
}

TEST(PublishedShift, EndsWithoutReversalsButDrifts) {
  const Path path = published_style_path();
  const std::vector<double> shifted = published_shift(path.angle, 0.05, 1);
  EXPECT_EQ(count_reversals(shifted), 0U);
  EXPECT_NEAR(largest_difference(shifted, path.angle), 5.4, 1e-9);  // 108 increments of 0.05
  // Its second step: least squares on four cubic basis functions.
  const MonotoneFit smooth = fit_monotone({path.s, shifted, 4, 0}).value();
  std::vector<double> smoothed;
  for (const double s : path.s) {
    smoothed.push_back(smooth.spline.at(s));
  }
  EXPECT_EQ(count_reversals(smoothed), 0U);
  EXPECT_NEAR(largest_difference(smoothed, path.angle), 6.18, 0.01);
  const Unreversed anchored = remove_reversals({path.s, path.angle, 2.5, 16}).value();
  EXPECT_EQ(anchored.reversals_after, 0U);
  EXPECT_LT(anchored.largest_deviation, 0.6);
}

// There and back: each way in its own sense, the drift carried on over the turn.
TEST(PublishedShift, BetweenIntendedTurnsKeepsTheseAlone) {
  std::vector<double> angle;
  for (int k = 0; k <= 400; ++k) {
    const double s = k / 200.0;
    angle.push_back(30 * (s < 1 ? s : 2 - s) + 1.6 * std::sin(8 * 3.14159265358979323846 * s));
  }
  EXPECT_GT(count_reversals(angle), 9U);
  const Shifted shifted = published_shift_between_turns(angle, 5, 0.05);
  EXPECT_EQ(shifted.angle.size(), angle.size());
  EXPECT_EQ(shifted.reversals_after, 1U);
  EXPECT_GT(shifted.largest_deviation, 2);
  EXPECT_LE(shifted.rms_deviation, shifted.largest_deviation);
}

TEST(IntendedTurns, LeaveOutASmallDipAtEitherEnd) {
  const std::vector<double> path{0, -0.1, 2, 4, 3.9, 5, 4.9};
  EXPECT_EQ(intended_turns(path, 0.5), (std::vector<std::size_t>{0, 6}));
  const std::vector<double> mirrored{0, 0.1, -2, -4, -3.9, -5, -4.9};
  EXPECT_EQ(intended_turns(mirrored, 0.5), (std::vector<std::size_t>{0, 6}));
  EXPECT_EQ(intended_turns(path, 0.05), (std::vector<std::size_t>{0, 1, 3, 4, 5, 6}));
}

TEST(Unwrap, CountsTurnsAndKeepsHalfTurnsTheWayTheyWere) {
  const std::vector<double> wrapped{170, -170, -90, 0, 90, 179, -179};
  const std::vector<double> whole = unwrapped(wrapped, 360);
  const double expected[] = {170, 190, 270, 360, 450, 539, 541};
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_EQ(whole[k], expected[k]);
  }
  EXPECT_EQ(unwrapped(std::vector<double>{0, 180, 0}, 360)[1], 180);
  EXPECT_EQ(unwrapped(std::vector<double>{0, -180, 0}, 360)[1], -180);
  std::vector<double> many;
  for (int k = 0; k < 3'000'000; ++k) {
    many.push_back(std::remainder(k * 120.0, 360.0));
  }
  EXPECT_EQ(unwrapped(many, 360).back(), 2'999'999 * 120.0);
}

TEST(RotaryProgram, ReadsModalWordsAndSkipsComments) {
  const RotaryPath path = parse_rotary_program("(A5 C5)\nG0 X1 Y2 Z3\nG1 a-10.5 C+20 ; A9\nX4\nF9\nC30\nZ9\n").value();
  ASSERT_EQ(path.c_deg.size(), 2U);
  EXPECT_EQ(path.a_deg[1], -10.5);
  EXPECT_EQ(path.c_deg[0], 20);
  EXPECT_EQ(path.xyz_mm[1][0], 4);
  EXPECT_EQ(path.line[1], 6U);
  ASSERT_EQ(path.linear.size(), 2U);  // X4 and Z9, with the angles of the block before them
  EXPECT_EQ(path.linear[0].block, 0U);
  EXPECT_EQ(path.linear[0].line, 4U);
  EXPECT_EQ(path.linear[0].xyz_mm[1], 2);
  EXPECT_EQ(path.linear[1].block, 1U);
  EXPECT_EQ(path.linear[1].xyz_mm[2], 9);
  EXPECT_NE(parse_rotary_program("G1\nA C3\n").error().message.find("program:2:"), std::string::npos);
}

}  // namespace
}  // namespace gravure::motion
