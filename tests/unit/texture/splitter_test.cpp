#include "gravure/texture/splitter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dice.hpp"
#include "published_surface.hpp"

namespace gravure::texture {
namespace {

using gravure::test::Dice;

constexpr SplitMethod kMethods[] = {SplitMethod::gaussian, SplitMethod::savitzky_golay, SplitMethod::fft,
                                    SplitMethod::adaptive, SplitMethod::optimal};
constexpr double kLoose = 1e6;
constexpr DeviationLimits kNoLimits{kLoose, kLoose, kLoose};

TexturePath hilbert(int order) {
  TexturePath path;
  path.points_mm = hilbert_curve(order, 40).value();
  path.step_mm = (path.points_mm[1] - path.points_mm[0]).norm();
  return path;
}

std::unique_ptr<Splitter> splitter(SplitMethod method) {
  return make_splitter(method, {.sigma_mm = 0, .cut = 8});
}

std::vector<Vector2> stages(SplitMethod method, const std::vector<Vector2>& points, double step_mm, double sigma_mm,
                            const DeviationLimits& limits = kNoLimits) {
  const auto plane = expression_surface("0").value();
  const TexturePath path{points, step_mm};
  const std::vector<SurfacePoint> targets = test::on(*plane, points);
  auto found = splitter(method)->stages_mm({*plane, path, targets, sigma_mm, limits}, CancelToken());
  EXPECT_TRUE(found) << found.error().message;
  return std::move(found).value();
}

TEST(Splitter, OfEveryKindLeavesStraightPathsAlone) {
  std::vector<Vector2> path;
  for (int i = 0; i < 400; ++i) {
    path.emplace_back(0.03 * i - 2, 1 - 0.04 * i);
  }
  for (const SplitMethod method : kMethods) {
    const std::vector<Vector2> slow = stages(method, path, 0.05, 3, {1, 1, 1});
    for (std::size_t i = 0; i < path.size(); ++i) {
      // What is straight is smoothest wherever it lies in the tube; what is left are digits of the equations.
      const double most_mm = method == SplitMethod::optimal ? 1e-3 : 1e-11;
      EXPECT_LT((slow[i] - path[i]).norm(), most_mm) << split_method_name(method) << ", point " << i;
    }
  }
}

/// The sigma of all linear ways halves waves of one length.
TEST(Splitter, OfLinearKindsHalvesTheSameWave) {
  const double sigma_mm = 2;
  const double wavelength_mm = 2 * std::numbers::pi * sigma_mm / std::sqrt(2 * std::log(2.0));
  for (const SplitMethod method : {SplitMethod::gaussian, SplitMethod::savitzky_golay, SplitMethod::fft}) {
    std::vector<Vector2> path;
    constexpr int kHalf = 6000;
    for (int i = -kHalf; i <= kHalf; ++i) {
      path.emplace_back(0, std::cos(2 * std::numbers::pi * 0.02 * i / wavelength_mm));
    }
    EXPECT_NEAR(stages(method, path, 0.02, sigma_mm)[kHalf].y(), 0.5, method == SplitMethod::gaussian ? 1e-9 : 5e-3)
        << split_method_name(method);
  }
}

/// Least squares of a cubic over the window, by normal equations of its four unknowns.
TEST(Splitter, OfSavitzkyAndGolayKeepsCubics) {
  std::vector<Vector2> path;
  for (int i = -300; i <= 300; ++i) {
    const double t = 0.01 * i;
    path.emplace_back(t + 0.3 * t * t, 0.2 * t * t * t - t);
  }
  const std::vector<Vector2> slow = stages(SplitMethod::savitzky_golay, path, 0.02, 0.4);
  for (std::size_t i = 100; i < 500; ++i) {  // ends are mirrored: not cubic there
    EXPECT_LT((slow[i] - path[i]).norm(), 1e-10) << i;
  }
}

/// 1 / (1 + (w / w_half)^8): waves well below the half are kept, those well above are gone.
TEST(Splitter, OfFftPassesSlowWavesOnly) {
  const double half_wave_mm = 2 * std::numbers::pi * 0.5 / std::sqrt(2 * std::log(2.0));
  for (const double share : {0.4, 0.8, 1.0, 1.5, 3.0}) {
    std::vector<Vector2> path;
    for (int i = -3000; i <= 3000; ++i) {
      path.emplace_back(0, std::cos(2 * std::numbers::pi * 0.01 * i * share / half_wave_mm));
    }
    EXPECT_NEAR(stages(SplitMethod::fft, path, 0.01, 0.5)[3000].y(), 1 / (1 + std::pow(share, 8)), 1e-9) << share;
  }
}

/// What reaches far beyond a path is folded back: the same as from the mirrored path written out that far.
TEST(Splitter, FoldsWeightsThatReachFarBeyondThePath) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  struct Case {
    SplitMethod method;
    double sigma_steps;
    std::int64_t points;
  };
  for (const Case& each : {Case{SplitMethod::gaussian, 8500, 12'000}, Case{SplitMethod::savitzky_golay, 20'000, 12'000},
                           Case{SplitMethod::fft, 800, 2000}}) {
    const std::int64_t last = each.points - 1;
    std::vector<Vector2> path(static_cast<std::size_t>(each.points), Vector2(5, -3));
    for (std::size_t i = 1; i < path.size(); ++i) {
      path[i] =
          path[i - 1] + Vector2(static_cast<double>(dice.between(-10, 30)), static_cast<double>(dice.between(-20, 20)));
    }
    const std::int64_t reach = (72'000 / (2 * last) + 1) * 2 * last;  // whole turns to both sides
    std::vector<Vector2> mirrored;
    for (std::int64_t i = -reach; i <= last + reach; ++i) {
      const std::int64_t place = ((i % (2 * last)) + 2 * last) % (2 * last);
      const Vector2 shift = static_cast<double>((i - place) / last) * (path.back() - path.front());
      mirrored.push_back(place <= last
                             ? Vector2(path[static_cast<std::size_t>(place)] + shift)
                             : Vector2(2 * path.back() - path[static_cast<std::size_t>(2 * last - place)] + shift));
    }
    const std::vector<Vector2> folded = stages(each.method, path, 1, each.sigma_steps);
    const std::vector<Vector2> whole = stages(each.method, mirrored, 1, each.sigma_steps);
    double most = 0;
    double apart = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      most = std::max(most, (folded[i] - path[i]).norm());
      apart = std::max(apart, (folded[i] - whole[i + static_cast<std::size_t>(reach)]).norm());
    }
    EXPECT_LT(apart, 1e-9 * (path.back() - path.front()).norm()) << split_method_name(each.method);
    EXPECT_GT(most, 1) << split_method_name(each.method);
  }
}

TEST(Splitter, RefusesOrBearsEverySigma) {
  const auto plane = expression_surface("0").value();
  const TexturePath path = hilbert(3);
  const std::vector<SurfacePoint> targets = test::on(*plane, path.points_mm);
  for (const SplitMethod method : {SplitMethod::gaussian, SplitMethod::savitzky_golay, SplitMethod::fft}) {
    for (const double sigma_mm : {1e-9, 1e3, 1e6, 1e15}) {
      const auto slow = splitter(method)->stages_mm({*plane, path, targets, sigma_mm, kNoLimits}, CancelToken());
      if (!slow) {
        EXPECT_EQ(slow.error().code, ErrorCode::out_of_range) << sigma_mm;
        EXPECT_GT(sigma_mm, 1e3);
      } else if (sigma_mm < 1) {
        EXPECT_LT((slow.value()[9] - path.points_mm[9]).norm(), 1e-9) << split_method_name(method);
      }
    }
  }
}

TEST(Splitter, OfAdaptiveKindIsTheGaussianWhereNothingBindsIt) {
  const TexturePath path = hilbert(4);
  const std::vector<Vector2> wide = stages(SplitMethod::gaussian, path.points_mm, path.step_mm, 6);
  const std::vector<Vector2> adapted = stages(SplitMethod::adaptive, path.points_mm, path.step_mm, 6);
  for (std::size_t i = 0; i < wide.size(); ++i) {
    EXPECT_LT((wide[i] - adapted[i]).norm(), 1e-12);
  }
}

TEST(Splitter, ThatKeepsLimitsDoesSoAtEveryPoint) {
  const auto surface = test::published_surface();
  const TexturePath path = hilbert(5);
  for (const DeviationLimits& limits :
       {DeviationLimits{}, DeviationLimits{.focus_mm = 0.02}, DeviationLimits{.displacement_mm = 0.4},
        DeviationLimits{.incidence_rad = 0.02}}) {
    for (const SplitMethod method : {SplitMethod::adaptive, SplitMethod::optimal}) {
      ASSERT_TRUE(splitter(method)->keeps_limits());
      const auto split = split_by_published_rule(*splitter(method), *surface, path, limits, CancelToken());
      ASSERT_TRUE(split) << split_method_name(method) << ": " << split.error().message;
      EXPECT_TRUE(violations(split.value().most, limits).empty()) << split_method_name(method);
      EXPECT_EQ(split.value().tries, 1);
    }
  }
}

/// One spot dictates what a single Gaussian does everywhere; the others do not let it.
TEST(Splitter, NarrowsWhereABumpAsksForItOnly) {
  const auto bump = expression_surface("1.5*exp(-((x-12)^2+(y-12)^2)/18)").value();
  const TexturePath path = hilbert(5);
  const auto split_by = [&](SplitMethod method, double reach_mm) {
    auto split = split_by_published_rule(*splitter(method), *bump, path, {.displacement_mm = reach_mm}, CancelToken());
    EXPECT_TRUE(split) << split.error().message;
    return std::move(split).value();
  };
  const Split gaussian = split_by(SplitMethod::gaussian, 20);
  const Split adapted = split_by(SplitMethod::adaptive, 20);
  const Split optimal = split_by(SplitMethod::optimal, 5);
  const double jerk = stage_demand(gaussian.stages, path.step_mm).rms_jerk_per_mm2;
  EXPECT_LT(stage_demand(adapted.stages, path.step_mm).rms_jerk_per_mm2, 0.5 * jerk);
  EXPECT_LT(stage_demand(optimal.stages, path.step_mm).rms_jerk_per_mm2, 0.25 * jerk);
  // Far from the bump the widest sigma is left.
  const std::vector<Vector2> wide = stages(SplitMethod::gaussian, path.points_mm, path.step_mm, 30);
  EXPECT_LT((adapted.stages[100].position_mm.head<2>() - wide[100]).norm(), 1e-9);
}

/// On a plane the tube is exact: no path within it that comes from the found one by a bend of any kind is smoother.
TEST(Splitter, OfOptimalKindCannotBeMadeSmoother) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  const auto plane = expression_surface("0").value();
  const TexturePath path = hilbert(3);
  const DeviationLimits limits{.displacement_mm = 3};
  const auto split = split_path(*splitter(SplitMethod::optimal), *plane, path, limits, 30, CancelToken());
  ASSERT_TRUE(split) << split.error().message;
  const auto roughness = [](const std::vector<Vector2>& at) {
    double sum = 0;
    for (std::size_t i = 0; i + 3 < at.size(); ++i) {
      sum += (at[i + 3] - 3 * at[i + 2] + 3 * at[i + 1] - at[i]).squaredNorm();
    }
    return sum;
  };
  std::vector<Vector2> best;
  for (const SurfacePoint& stage : split.value().stages) {
    best.emplace_back(stage.position_mm.head<2>());
  }
  const double found = roughness(best);
  EXPECT_GT(found, 0);
  const int last = static_cast<int>(best.size());
  for (int trial = 0; trial < 3000; ++trial) {
    const auto centre = static_cast<double>(dice.between(0, last));
    const auto width = static_cast<double>(dice.between(2, 25));
    const Vector2 push(0.001 * static_cast<double>(dice.between(-100, 100)),
                       0.001 * static_cast<double>(dice.between(-100, 100)));
    std::vector<Vector2> other = best;
    bool allowed = true;
    for (std::size_t i = 0; i < other.size(); ++i) {
      const double t = (static_cast<double>(i) - centre) / width;
      other[i] += std::exp(-t * t) * push;
      allowed = allowed && (other[i] - path.points_mm[i]).norm() <= 0.97 * limits.displacement_mm;
    }
    if (allowed) {
      EXPECT_GT(roughness(other), 0.97 * found) << "bent by " << push.transpose() << " mm at " << centre;
    }
  }
}

TEST(Splitter, SaysWhatItCannotKeep) {
  const auto surface = test::published_surface();
  const TexturePath path = hilbert(3);
  for (const SplitMethod method : {SplitMethod::gaussian, SplitMethod::savitzky_golay, SplitMethod::fft}) {
    EXPECT_EQ(split_path(*splitter(method), *surface, path, {}, 0, CancelToken()).error().code,
              ErrorCode::out_of_range);
    EXPECT_EQ(split_path(*splitter(method), *surface, path, {}, NAN, CancelToken()).error().code,
              ErrorCode::out_of_range);
  }
  CancelToken cancel;
  cancel.cancel();
  for (const SplitMethod method : {SplitMethod::adaptive, SplitMethod::optimal}) {
    EXPECT_EQ(split_path(*splitter(method), *surface, path, {}, 30, cancel).error().code, ErrorCode::cancelled);
  }
}

/// x = t^3 / 6 along a straight line has third derivative 1, second t.
TEST(StageDemand, IsThatOfDerivativesByLength) {
  std::vector<SurfacePoint> stages(101);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const double t = 0.02 * static_cast<double>(i);
    stages[i].position_mm = Vector3(t * t * t / 6, 0, 0);
  }
  const StageDemand demand = stage_demand(stages, 0.02);
  EXPECT_NEAR(demand.max_jerk_per_mm2, 1, 1e-8);
  EXPECT_NEAR(demand.rms_jerk_per_mm2, 1, 1e-8);
  EXPECT_NEAR(demand.max_bend_per_mm, 1.98, 1e-8);
}

}  // namespace
}  // namespace gravure::texture
