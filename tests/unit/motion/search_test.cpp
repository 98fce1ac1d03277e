#include "gravure/motion/search.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "gravure/motion/shaper.hpp"
#include "indexing_models.hpp"
#include "motion_test_support.hpp"
#include "residual_kernel.hpp"

namespace gravure::motion {
namespace {

SearchProblem published(const std::vector<Mode>& modes) {
  return {20, 500, 30000, 30000, 1e21, 250, modes, test::kPublishedBand, 5};
}

/// 38 and 91 Hz; 500 mm/s, 10 m/s^2, 5000 m/s^3; settled to 1 um.
SearchProblem fine_stage(double stroke_mm) {
  return {stroke_mm, 500, 10000, 10000, 5e6, 250, {{38, 0.03, 1}, {91, 0.02, 0.4}}, {BandOf::position, 1e-3}, 5};
}

const Alternative& named(const SearchReport& report, std::string_view name) {
  for (const Alternative& row : report.alternatives) {
    if (row.name == name) {
      return row;
    }
  }
  ADD_FAILURE() << "no " << name;
  return report.alternatives.front();
}

TEST(ResidualKernel, EqualsTheSumOverAllJumps) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  for (int trial = 0; trial < 2000; ++trial) {
    const double tj = trial % 10 == 0 ? 0 : random.log_between(1e-4, 0.05);
    const Durations d{tj, tj + random.log_between(1e-4, 0.05), tj + random.log_between(1e-4, 0.05),
                      random.log_between(1e-5, 0.1)};
    const double v = random.log_between(10, 500);
    const SFactorRequest request{
        {v * d.stroke_over_velocity_s(), v, v / d.up_s, v / d.down_s, 0, 0}, d.jerk_s / 250e-6, 250};
    const auto input = input_of(plan_profile(request).value());
    for (const BandOf of : {BandOf::acceleration, BandOf::position}) {
      const ResidualSignal sum = residual_of(test::fit_b(), input, of);
      const ResidualSignal fast = ResidualKernel(test::fit_b(), of).residual(d, v);
      const double scale = 1e-9 * (of == BandOf::acceleration ? v / std::min(d.up_s, d.down_s) : v * 1e-3);
      for (std::size_t i = 0; i < 2; ++i) {
        ASSERT_NEAR(std::abs(sum.terms()[i].amplitude - fast.terms()[i].amplitude), 0, scale) << trial;
      }
    }
  }
}

TEST(PublishedGrid, HasTheStatedNumberOfFeasiblePointsAndTheStatedOptima) {
  const GridSearch b = search_grid(published(test::fit_b()), {}, false, 116.1e-3).value();
  EXPECT_EQ(b.evaluated, 61634U);
  EXPECT_EQ(b.best.v_mm_s, 390);
  EXPECT_EQ(b.best.a_up_mm_s2, 13500);
  EXPECT_EQ(b.best.s_factor, 87.5);
  EXPECT_NEAR(b.best.positioning_time_s, 112.1e-3, 5e-5);
  // The source of the models states 94 and 1,609 points below the mark. These are the counts for its printed (rounded)
  // parameters; rounding explains no more than 96 to 97 and 1,601 to 1,606. The test below counts in another way.
  EXPECT_EQ(b.below_mark, 96U);
  const GridSearch a = search_grid(published(test::fit_a()), {}, false, 116.1e-3).value();
  EXPECT_EQ(a.evaluated, 61634U);
  EXPECT_NEAR(a.best.positioning_time_s, 105.9e-3, 1e-4);
  EXPECT_EQ(a.below_mark, 1604U);
}

/// The last 10 us step at which the signal is outside, then bisection: no bound, no walk.
double scanned_exit_s(const ResidualSignal& signal, double tolerance, double from_s) {
  constexpr double kStep_s = 1e-5;
  double out_s = from_s;
  while (out_s > 0 && std::abs(signal.at(out_s)) <= tolerance) {
    out_s -= kStep_s;
  }
  double in_s = out_s + kStep_s;
  for (int step = 0; step < 50; ++step) {
    const double middle_s = (out_s + in_s) / 2;
    (std::abs(signal.at(middle_s)) > tolerance ? out_s : in_s) = middle_s;
  }
  return std::max(0.0, out_s);
}

TEST(PublishedGrid, CountsBelowTheMarkAsAScanOfEveryPointInTenMicrosecondStepsDoes) {
  constexpr double kMark_s = 116.1e-3;
  const SearchGrid grid;
  for (const auto& [modes, expected] : {std::pair(test::fit_b(), 96), std::pair(test::fit_a(), 1604)}) {
    int below = 0;
    for (std::size_t v = 0; v < grid.v_mm_s.count(); ++v) {
      for (std::size_t a = 0; a < grid.a_mm_s2.count(); ++a) {
        for (std::size_t s = 0; s < grid.s_factor.count(); ++s) {
          const double jerk_s = grid.s_factor.at(s) * 250e-6;
          const double ramp_s = grid.v_mm_s.at(v) / grid.a_mm_s2.at(a);
          const double cruise_s = 20 / grid.v_mm_s.at(v) - ramp_s - jerk_s;
          const double access_s = 2 * ramp_s + 2 * jerk_s + cruise_s;
          if (jerk_s <= ramp_s + 1e-15 && cruise_s >= -1e-15 && access_s < kMark_s) {
            const auto request =
                test::indexing(grid.v_mm_s.at(v), grid.a_mm_s2.at(a), grid.a_mm_s2.at(a), grid.s_factor.at(s));
            const auto signal = residual_of(modes, input_of(plan_profile(request).value()), BandOf::acceleration);
            below += access_s + scanned_exit_s(signal, 840, signal.envelope_time_s(840)) < kMark_s ? 1 : 0;
          }
        }
      }
    }
    EXPECT_EQ(below, expected);
  }
}

TEST(PublishedGrid, DecidesEveryPointAsItsOwnPositioningTimeDoes) {
  const SearchProblem problem = published(test::fit_b());
  const SearchGrid coarse{{200, 500, 50}, {10000, 30000, 4000}, {2.5, 115, 12.5}};
  const GridSearch found = search_grid(problem, coarse, true).value();
  std::uint64_t feasible = 0;
  double best = 1e9;
  for (std::size_t v = 0; v < coarse.v_mm_s.count(); ++v) {
    for (std::size_t u = 0; u < coarse.a_mm_s2.count(); ++u) {
      for (std::size_t d = 0; d < coarse.a_mm_s2.count(); ++d) {
        for (std::size_t s = 0; s < coarse.s_factor.count(); ++s) {
          const auto request =
              test::indexing(coarse.v_mm_s.at(v), coarse.a_mm_s2.at(u), coarse.a_mm_s2.at(d), coarse.s_factor.at(s));
          const Profile profile = plan_profile(request).value();
          if (!profile.reduced.velocity && !profile.reduced.acceleration()) {
            ++feasible;
            best = std::min(best, test::positioning_ms(problem.modes, request));
          }
        }
      }
    }
  }
  EXPECT_EQ(found.evaluated, feasible);
  EXPECT_NEAR(found.best.positioning_time_s * 1e3, best, 1e-9);
}

TEST(PublishedGrid, AsymmetricIsCompleteAndNotWorseThanSymmetric) {
  for (const auto& modes : {test::fit_a(), test::fit_b()}) {
    const GridSearch symmetric = search_grid(published(modes), {}, false).value();
    const GridSearch asymmetric = search_grid(published(modes), {}, true).value();
    EXPECT_GT(asymmetric.evaluated, 20 * symmetric.evaluated);
    EXPECT_LE(asymmetric.best.positioning_time_s, symmetric.best.positioning_time_s);
    RecordProperty("asymmetric_points", std::to_string(asymmetric.evaluated));
  }
}

TEST(Search, BeatsBothGridsAndTheReportIsConsistent) {
  for (const auto& modes : {test::fit_a(), test::fit_b()}) {
    const SearchProblem problem = published(modes);
    const double symmetric_grid = search_grid(problem, {}, false).value().best.positioning_time_s;
    const double asymmetric_grid = search_grid(problem, {}, true).value().best.positioning_time_s;
    SearchOptions options;
    options.grid = SearchGrid{};
    const SearchReport report = search(problem, options).value();
    EXPECT_LT(named(report, "best_symmetric").positioning_time_s, symmetric_grid);
    EXPECT_LT(named(report, "best_asymmetric").positioning_time_s, asymmetric_grid);
    EXPECT_LE(named(report, "best_asymmetric").positioning_time_s,
              named(report, "best_symmetric").positioning_time_s * (1 + 1e-9));
    EXPECT_LE(named(report, "robust").worst_positioning_time_s,
              named(report, "best_asymmetric").worst_positioning_time_s);
    for (const Alternative& row : report.alternatives) {
      EXPECT_GE(row.worst_positioning_time_s, row.positioning_time_s * (1 - 1e-12)) << row.name;
      EXPECT_GE(row.positioning_time_s, row.access_time_s) << row.name;
      EXPECT_GE(row.envelope_time_s, row.positioning_time_s * (1 - 1e-12)) << row.name;
      EXPECT_TRUE(row.profile.has_value());
    }
    ASSERT_TRUE(report.grids.has_value());
    EXPECT_EQ(report.grids->symmetric.evaluated, 61634U);
    EXPECT_EQ(report.grids->symmetric.best.positioning_time_s, symmetric_grid);
    EXPECT_EQ(report.grids->asymmetric.best.positioning_time_s, asymmetric_grid);
    for (const char* other : {"fastest", "best_symmetric"}) {
      const bool slower =
          named(report, "best_asymmetric").worst_positioning_time_s > named(report, other).worst_positioning_time_s;
      const std::string words = std::string("best_asymmetric is slower than ") + other;
      EXPECT_EQ(report.verdict.find(words) != std::string::npos, slower) << other;
    }
    EXPECT_NE(report.verdict.find(report.shortest), std::string::npos);
    const auto gains = report.verdict.find("Gain of best_asymmetric");
    ASSERT_NE(gains, std::string::npos);
    for (const char* other : {"fastest", "best_symmetric", "zv", "zvd"}) {
      EXPECT_NE(report.verdict.find(other, gains), std::string::npos) << other;
    }
    std::cout << report.verdict << " (" << report.evaluated << " evaluated)\n";
  }
}

TEST(Search, SaysWhereAShaperWins) {
  for (const double stroke : {0.1, 1.0, 10.0, 50.0}) {
    const SearchReport report = search(fine_stage(stroke), {}).value();
    std::cout << stroke << " mm: " << report.verdict << "\n";
    const Candidate& best = report.best;
    EXPECT_LE(best.v_mm_s, 500 * (1 + 1e-12));
    EXPECT_LE(best.a_up_mm_s2, 10000 * (1 + 1e-12));
    EXPECT_LE(best.a_down_mm_s2 / (best.s_factor * 250e-6), 5e6 * (1 + 1e-9));
    EXPECT_LT(named(report, "best_asymmetric").positioning_time_s, named(report, "fastest").positioning_time_s / 3);
    if (report.shortest == "zv") {
      EXPECT_NE(report.verdict.find("shaper wins"), std::string::npos);
    }
  }
  EXPECT_EQ(search(fine_stage(0.1), {}).value().shortest, "zv");
}

TEST(Search, IsNeverWorseForMoreEffortOrAGridAndHardlyDependsOnTheSeed) {
  for (const double stroke : {0.3, 28.0}) {
    const SearchProblem problem = fine_stage(stroke);
    SearchOptions options;
    const SearchReport first = search(problem, options).value();
    const auto judge = [&](const SearchReport& better, const std::string& why) {
      for (const char* name : {"best_symmetric", "best_asymmetric"}) {
        EXPECT_LE(named(better, name).positioning_time_s, named(first, name).positioning_time_s) << why << stroke;
      }
      EXPECT_LE(named(better, "best_asymmetric").positioning_time_s,
                named(better, "best_symmetric").positioning_time_s);
      for (const char* name : {"best_symmetric", "best_asymmetric"}) {
        EXPECT_LE(named(better, "robust").worst_positioning_time_s, named(better, name).worst_positioning_time_s);
      }
      EXPECT_LE(named(better, "robust").worst_positioning_time_s, named(first, "robust").worst_positioning_time_s)
          << why << stroke;
    };
    options.effort = 3;
    judge(search(problem, options).value(), "effort 3, ");
    options = {};
    options.grid = SearchGrid{{100, 500, 50}, {1000, 10000, 1000}, {2.5, 115, 5}};
    if (search_grid(problem, *options.grid, false)) {  // the smallest stroke has no point on it
      judge(search(problem, options).value(), "grid, ");
    }
    options = {};
    for (const std::uint64_t seed : {77U}) {
      options.seed = seed;
      const SearchReport other = search(problem, options).value();
      EXPECT_NEAR(other.best.positioning_time_s / first.best.positioning_time_s, 1, 0.1) << stroke;
      EXPECT_NEAR(named(other, "robust").worst_positioning_time_s / named(first, "robust").worst_positioning_time_s, 1,
                  0.03)
          << stroke;
    }
  }
}

TEST(Search, KeepsItsLimitsToTheLastBit) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  for (int trial = 0; trial < 10; ++trial) {
    SearchProblem problem = fine_stage(random.log_between(0.1, 50));
    problem.v_max_mm_s = random.log_between(50, 700);
    problem.a_up_max_mm_s2 = random.log_between(1000, 20000);
    problem.a_down_max_mm_s2 = random.log_between(1000, 20000);
    problem.jerk_max_mm_s3 = random.log_between(1e5, 1e7);
    SearchOptions options;
    options.robust = false;
    const auto found = search(problem, options);
    ASSERT_TRUE(found) << found.error().message;
    for (const Alternative& row : found.value().alternatives) {
      const Candidate& c = row.profile.value();
      EXPECT_LE(c.v_mm_s, problem.v_max_mm_s) << row.name;
      EXPECT_LE(c.a_up_mm_s2, problem.a_up_max_mm_s2) << row.name;
      EXPECT_LE(c.a_down_mm_s2, problem.a_down_max_mm_s2) << row.name;
      const double jerk_s = c.s_factor * problem.update_us * 1e-6;
      EXPECT_LE(std::max(c.a_up_mm_s2, c.a_down_mm_s2) / jerk_s, problem.jerk_max_mm_s3) << row.name;
    }
  }
}

TEST(Search, TakesStrokesOfEitherSenseAndNone) {
  SearchProblem problem = fine_stage(5);
  const SearchReport forward = search(problem, {}).value();
  problem.stroke_mm = -5;
  const SearchReport backward = search(problem, {}).value();
  EXPECT_EQ(forward.verdict, backward.verdict);
  EXPECT_EQ(forward.best.positioning_time_s, backward.best.positioning_time_s);
  problem.stroke_mm = 0;
  const SearchReport none = search(problem, {}).value();
  EXPECT_EQ(none.alternatives.size(), forward.alternatives.size());
  EXPECT_EQ(none.best.positioning_time_s, 0);
  EXPECT_NE(none.verdict.find("nothing moves"), std::string::npos);
  for (const double jerk : {1e-12, 1e-6}) {
    problem.jerk_max_mm_s3 = jerk;
    const auto refused = search(problem, {});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("jerk_max_mm_s3"), std::string::npos) << refused.error().message;
  }
}

TEST(Search, IsTheSameEveryTime) {
  const SearchProblem problem = fine_stage(5);
  const SearchReport first = search(problem, {}).value();
  const SearchReport second = search(problem, {}).value();
  EXPECT_EQ(first.verdict, second.verdict);
  EXPECT_EQ(first.best.positioning_time_s, second.best.positioning_time_s);
}

TEST(Search, RefusesWhatItCannotSearch) {
  SearchProblem problem = published(test::fit_b());
  EXPECT_EQ(search_grid(problem, {{200, 500, 0}, {1, 2, 1}, {1, 2, 1}}, false).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(search_grid(problem, {{1, 500, 1e-4}, {1, 2e4, 1e-2}, {1, 2, 1}}, true).error().code,
            ErrorCode::out_of_range);
  EXPECT_EQ(search_grid(problem, {{400, 500, 5}, {1000, 2000, 500}, {1, 2, 1}}, false).error().code,
            ErrorCode::bad_argument);
  problem.modes.clear();
  EXPECT_FALSE(search(problem, {}));
  problem = published(test::fit_b());
  problem.stroke_mm = 1e-13;
  EXPECT_FALSE(search(problem, {}));
}

TEST(Shaper, LeavesNoVibrationOfTheModesItIsMadeFor) {
  const Profile profile = plan_profile(test::indexing(500, 30000, 30000, 0)).value();
  for (const ShaperKind kind : {ShaperKind::zv, ShaperKind::zvd}) {
    const auto shaper = make_shaper(kind, test::fit_b()).value();
    double sum = 0;
    for (const ShaperImpulse& impulse : shaper) {
      sum += impulse.size;
    }
    EXPECT_NEAR(sum, 1, 1e-15);
    const auto shaped = shape_input(input_of(profile), shaper);
    EXPECT_LT(residual_of(test::fit_b(), shaped, BandOf::acceleration).envelope(0), 1e-8 * 30000);
  }
  EXPECT_EQ(make_shaper(ShaperKind::zv, test::fit_b()).value().size(), 4U);
  EXPECT_EQ(make_shaper(ShaperKind::zvd, test::fit_b()).value().size(), 9U);
}

TEST(Shaper, ZvdForgivesMoreThanZv) {
  const auto input = input_of(plan_profile(test::indexing(500, 30000, 30000, 0)).value());
  std::vector<Mode> off = test::fit_b();
  off[0].f_hz *= 1.05;
  off[1].f_hz *= 0.95;
  const auto residual = [&](ShaperKind kind) {
    return residual_of(off, shape_input(input, make_shaper(kind, test::fit_b()).value()), BandOf::acceleration)
        .envelope(0);
  };
  EXPECT_LT(residual(ShaperKind::zvd), 0.3 * residual(ShaperKind::zv));
}

}  // namespace
}  // namespace gravure::motion
