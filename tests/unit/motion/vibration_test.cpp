#include "gravure/motion/vibration.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "indexing_models.hpp"
#include "motion_test_support.hpp"

namespace gravure::motion {
namespace {

using test::fit_b;
using test::indexing;

TEST(Residual, GivesThePublishedStyleVectorsOfTheFittedModel) {
  const auto modes = fit_b();
  const auto check = [&modes](const SFactorRequest& request, const std::array<double, 4>& expected) {
    const Profile profile = plan_profile(request).value();
    const auto input = input_of(profile);
    const ResidualSignal signal = residual_of(modes, input, BandOf::acceleration);
    const double after_s[] = {0, 0.005, 0.010, 0.020};
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(signal.at(after_s[i]), expected[i], 1e-5);
      EXPECT_NEAR(carried_at(modes, input, profile.access_time_s() + after_s[i]).acceleration_mm_s2, expected[i], 1e-5);
    }
  };
  check(indexing(375, 14000, 13500, 82.5), {762.588295, 2313.521513, 931.868807, -703.454719});
  check(indexing(500, 30000, 30000, 0), {-38381.519064, -18081.34816, 35459.412677, -4096.054938});
}

TEST(PositioningTime, ReproducesThePublishedTimesWithinTheFit) {
  // [C1] cases I to IV: 194.3, 165.5, 116.1 (simulated), 110.8 ms.
  const double fit_a_ms[] = {194.089, 165.457, 116.360, 110.677};
  const double fit_b_ms[] = {193.383, 165.858, 116.857, 111.831};
  const SFactorRequest first_three[] = {indexing(500, 30000, 30000, 22), indexing(300, 30000, 30000, 22),
                                        indexing(375, 14000, 14000, 105)};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(test::positioning_ms(test::fit_a(), first_three[i]), fit_a_ms[i], 6e-3) << i;
    EXPECT_NEAR(test::positioning_ms(test::fit_b(), first_three[i]), fit_b_ms[i], 6e-3) << i;
  }
  EXPECT_NEAR(test::positioning_ms(test::fit_a(), indexing(375, 14000, 13500, 82.5)), fit_a_ms[3], 6e-3);
  EXPECT_NEAR(test::positioning_ms(test::fit_b(), indexing(375, 14000, 13500, 85)), fit_b_ms[3], 6e-3);
}

TEST(PositioningTime, GivesTheVectorsOfTheFittedModel) {
  EXPECT_NEAR(test::positioning_ms(fit_b(), indexing(375, 14000, 13500, 82.5)), 118.083014, 1e-6);
  EXPECT_NEAR(test::positioning_ms(fit_b(), indexing(500, 30000, 30000, 0)), 218.857142, 1e-6);
  const double s_factors[] = {0, 22, 40, 60, 80, 92.5, 100, 105};
  const double expected_ms[] = {173.934, 169.777, 139.221, 131.001, 132.627, 121.326, 122.744, 116.857};
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(test::positioning_ms(fit_b(), indexing(375, 14000, 14000, s_factors[i])), expected_ms[i], 6e-4);
  }
}

TEST(ChainModes, SharesOfAnyNumberAddUpToOneAndFollowTheTwoMassFormula) {
  const auto two = fit_b();
  const double l1 = 36.206 * 36.206;
  const double l2 = 86.748 * 86.748;
  EXPECT_NEAR(two[0].participation, l2 / (l2 - l1), 1e-12);
  EXPECT_NEAR(two[1].participation, -l1 / (l2 - l1), 1e-12);
  const FrequencyAndDamping four[] = {{20, .1}, {45, .02}, {80, .03}, {130, 0}};
  double sum = 0;
  const auto modes = chain_modes(four).value();
  for (const Mode& mode : modes) {
    sum += mode.participation;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(ChainModes, RefusesEqualFrequenciesAndOverdampedModes) {
  const FrequencyAndDamping equal[] = {{40, .1}, {40, .2}};
  EXPECT_EQ(chain_modes(equal).error().code, ErrorCode::out_of_range);
  const FrequencyAndDamping over[] = {{40, 1.0}};
  EXPECT_EQ(chain_modes(over).error().code, ErrorCode::out_of_range);
  EXPECT_FALSE(chain_modes({}));
  EXPECT_FALSE(check_modes(std::vector<Mode>(kMaxModes + 1, Mode{1, 0, 1})));
}

/// Two masses in series on the moving base, by their matrices; states are displacements against the base.
class TwoMasses {
 public:
  /// Modal damping; mass ratio mu = m2 / m1 small enough for the frequencies.
  TwoMasses(const std::vector<Mode>& modes, double mu) {
    const double two_pi = 2 * std::acos(-1.0);
    const double w1 = two_pi * modes[0].f_hz;
    const double w2 = two_pi * modes[1].f_hz;
    const double sum = w1 * w1 + w2 * w2;
    const double product = w1 * w1 * w2 * w2;
    const double lead = 1 + 1 / mu;
    const double k2 = (sum - std::sqrt(sum * sum - 4 * lead * product * mu)) / (2 * lead);
    const double k1 = product * mu / k2;
    m2_ = mu;
    k_ = {k1 + k2, -k2, -k2, k2};
    // Columns phi with phi' M phi = 1; C = M Phi diag(2 zeta w) Phi' M.
    const double omegas[] = {w1, w2};
    for (std::size_t i = 0; i < 2; ++i) {
      const double x = k2;
      const double y = k1 + k2 - omegas[i] * omegas[i];
      const double norm = std::sqrt(x * x + mu * y * y);
      const double px = x / norm;
      const double py = mu * y / norm;
      const double d = 2 * modes[i].zeta * omegas[i];
      c_[0] += d * px * px;
      c_[1] += d * px * py;
      c_[2] += d * py * px;
      c_[3] += d * py * py;
    }
  }
  std::array<double, 4> slope(const std::array<double, 4>& s, double a) const {
    const double f1 = -(k_[0] * s[0] + k_[1] * s[1] + c_[0] * s[2] + c_[1] * s[3]);
    const double f2 = -(k_[2] * s[0] + k_[3] * s[1] + c_[2] * s[2] + c_[3] * s[3]);
    return {s[2], s[3], f1 - a, f2 / m2_ - a};
  }

 private:
  double m2_ = 0;
  std::array<double, 4> k_{};
  std::array<double, 4> c_{};
};

struct Instant {
  double time_s = 0;
  CarriedState state;
};

/// Runge-Kutta of fourth order with steps that end on every segment border.
std::vector<Instant> integrate(const TwoMasses& system, const Profile& profile, double until_s, double step_s) {
  std::vector<double> borders(profile.times_s.begin(), profile.times_s.end());
  borders.push_back(until_s);
  std::array<double, 4> s{};
  std::vector<Instant> instants;
  for (std::size_t b = 0; b + 1 < borders.size(); ++b) {
    const double length = borders[b + 1] - borders[b];
    const auto steps = static_cast<int>(std::ceil(length / step_s));
    const double h = steps > 0 ? length / steps : 0;
    const double start = b < 7 ? profile.acceleration_mm_s2[b] : 0;
    const double jerk = b < 7 ? profile.jerk_mm_s3[b] : 0;
    for (int i = 0; i < steps; ++i) {
      const auto a = [&](double into) { return start + jerk * (i * h + into); };
      const auto along = [&s](const std::array<double, 4>& d, double t) {
        return std::array<double, 4>{s[0] + t * d[0], s[1] + t * d[1], s[2] + t * d[2], s[3] + t * d[3]};
      };
      const auto d1 = system.slope(s, a(0));
      const auto d2 = system.slope(along(d1, h / 2), a(h / 2));
      const auto d3 = system.slope(along(d2, h / 2), a(h / 2));
      const auto d4 = system.slope(along(d3, h), a(h));
      for (std::size_t k = 0; k < 4; ++k) {
        s[k] += h / 6 * (d1[k] + 2 * d2[k] + 2 * d3[k] + d4[k]);
      }
      if (i + 1 < steps) {
        const double now = a(h);
        instants.push_back({borders[b] + (i + 1) * h, {now + system.slope(s, now)[3], s[1]}});
      }
    }
  }
  return instants;
}

TEST(CarriedState, EqualsTheIntegratedTwoMassSystemDuringAndAfterTheMove) {
  for (const auto& modes : {test::fit_a(), fit_b()}) {
    for (const double s_factor : {0.0, 22.0, 82.5}) {
      const Profile profile = plan_profile(indexing(375, 14000, 13500, s_factor)).value();
      const auto input = input_of(profile);
      const TwoMasses system(modes, 0.3);
      double largest = 0;
      for (const Instant& instant : integrate(system, profile, 0.3, 1e-5)) {
        const CarriedState state = carried_at(modes, input, instant.time_s);
        ASSERT_NEAR(state.acceleration_mm_s2, instant.state.acceleration_mm_s2, 2e-6 * 1e3) << instant.time_s;
        ASSERT_NEAR(state.deviation_mm, instant.state.deviation_mm, 1e-9) << instant.time_s;
        largest = std::max(largest, std::abs(state.acceleration_mm_s2));
      }
      EXPECT_GT(largest, 1e4);
    }
  }
}

TEST(CarriedState, IsTheSumOfManyModesAndOfAnUndampedOne) {
  // One undamped mode under a step of acceleration: z'' = -a cos(w t).
  const std::vector<Mode> modes{{10, 0, 0.25}, {10, 0, 0.75}};  // two equal modes are no special case
  const std::vector<InputJump> input{{0, 100, 0}, {1, -100, 0}};
  for (const double t : {0.0, 0.013, 0.4, 0.999}) {
    const double w = 2 * std::acos(-1.0) * 10;
    EXPECT_NEAR(carried_at(modes, input, t).acceleration_mm_s2, 100 - 100 * std::cos(w * t), 1e-9);
    EXPECT_NEAR(carried_at(modes, input, t).deviation_mm, -100 / (w * w) * (1 - std::cos(w * t)), 1e-12);
  }
}

/// Last exit by looking every `step_s`.
double scanned_exit_s(const ResidualSignal& signal, double tolerance, double until_s, double step_s) {
  double last = 0;
  for (double t = 0; t < until_s; t += step_s) {
    if (std::abs(signal.at(t)) > tolerance) {
      last = t;
    }
  }
  return last;
}

TEST(PositioningTime, IsTheLastExitThatDenseSamplingFindsForRandomModes) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  for (int trial = 0; trial < 300; ++trial) {
    ResidualSignal signal;
    for (int i = 0; i < 1 + trial % 4; ++i) {
      const double w = random.log_between(50, 2000);
      signal.add({{random.between(-1, 1), random.between(-1, 1)}, random.log_between(0.01, 0.3) * w, w});
    }
    const double tolerance = random.log_between(1e-3, 1);
    const double exit_s = signal.last_exit_s(tolerance);
    const double until_s = signal.envelope_time_s(tolerance);
    ASSERT_LE(exit_s, until_s);
    ASSERT_LE(signal.envelope(until_s), tolerance * (1 + 1e-9));
    const double step_s = std::max(1e-6, until_s / 20000);
    const double scanned = scanned_exit_s(signal, tolerance, until_s + step_s, step_s);
    ASSERT_GE(exit_s, scanned - 1e-12);
    if (exit_s > 0) {
      ASSERT_NEAR(std::abs(signal.at(exit_s)), tolerance, 1e-9 * tolerance);
    }
  }
}

TEST(PositioningTime, FindsAPeakThatOnlyJustLeavesTheBand) {
  // Im(exp((-d + i w) t)): peaks known in closed form; the band lies a hair under the fifth.
  const double d = 5;
  const double w = 300;
  ResidualSignal signal;
  signal.add({{1, 0}, d, w});
  const double half_turn = std::acos(-1.0) / w;
  const double peak_s = std::atan2(w, d) / w + 4 * half_turn;
  const double peak = std::abs(signal.at(peak_s));
  EXPECT_NEAR(signal.last_exit_s(peak * (1 - 1e-10)), peak_s, 1e-6);
  EXPECT_LT(signal.last_exit_s(peak * (1 + 1e-10)), peak_s - half_turn / 4);
}

// Peaks of beating modes with the band a hair under or over them: the hair decides.
TEST(PositioningTime, FindsPeaksOfSeveralModesThatTouchTheBand) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed() + 5);
  int peaks = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    ResidualSignal signal;
    double fastest = 0;
    const int modes = 1 + trial % 4;
    for (int i = 0; i < modes; ++i) {
      const double w = random.log_between(50, 1000);
      signal.add({{random.between(-1, 1), random.between(-1, 1)}, random.log_between(0.002, 0.3) * w, w});
      fastest = std::max(fastest, w);
    }
    // The last peak before a random instant, by climbing in ever smaller steps.
    double peak_s = random.between(0.005, 0.05);
    for (double step_s = 0.2 / fastest; step_s > 1e-12; step_s /= 2) {
      for (const double side : {-step_s, step_s}) {
        while (peak_s + side > 0 && std::abs(signal.at(peak_s + side)) > std::abs(signal.at(peak_s))) {
          peak_s += side;
        }
      }
    }
    const double peak = std::abs(signal.at(peak_s));
    if (peak_s < 1e-3 || peak < 1e-6) {
      continue;  // climbed out of the signal
    }
    ++peaks;
    const double under = signal.last_exit_s(peak * (1 - 1e-9));
    ASSERT_GE(under, peak_s - 1e-9) << trial;
    ASSERT_NEAR(std::abs(signal.at(under)), peak, 2e-9 * peak) << trial;
    const double over = signal.last_exit_s(peak * (1 + 1e-9));
    ASSERT_LE(over, under) << trial;
    const double until_s = signal.envelope_time_s(peak) + 1e-5;
    ASSERT_GE(over, scanned_exit_s(signal, peak * (1 + 1e-9), until_s, until_s / 5000) - 1e-12) << trial;
    ASSERT_GT(std::abs(over - peak_s), 1e-7 / fastest) << trial;
  }
  EXPECT_GT(peaks, 1000);
}

TEST(PositioningTime, IsNeverWhereAnUndampedModeExceedsTheBand) {
  const Profile profile = plan_profile(indexing(500, 30000, 30000, 22)).value();
  const std::vector<Mode> modes{{40, 0, 1}};
  const Settling settling = settle(modes, input_of(profile), test::kPublishedBand).value();
  EXPECT_TRUE(std::isinf(settling.positioning_time_s));
  const Settling wide = settle(modes, input_of(profile), {BandOf::acceleration, 1e9}).value();
  EXPECT_EQ(wide.positioning_time_s, wide.access_time_s);
}

// A mode that hardly decays and just fits the band, beside two that decay: the search must not start ages after the
// last exit (it would take hours).
TEST(PositioningTime, IsFoundBesideASlowModeThatJustFitsTheBand) {
  for (const double decay : {0.0, 1e-12, 1e-6, 1e-3}) {
    ResidualSignal signal;
    signal.add({{-1.1, -0.8}, 51, 221});
    signal.add({{0.002, -0.0008}, 18, 545});
    signal.add({{-326, 707}, decay, 6.283});
    const double slow = std::abs(signal.terms()[2].amplitude);
    for (const double room : {1e-2, 1e-4, 1e-6, 1e-9, 1e-12}) {
      const double tolerance = slow * (1 + room);
      const double exit_s = signal.last_exit_s(tolerance);
      double last_s = 0;
      for (int k = 0; k <= 500'000; ++k) {
        last_s = std::abs(signal.at(k * 1e-5)) > tolerance ? k * 1e-5 : last_s;
      }
      EXPECT_GE(exit_s, last_s) << decay << " " << room;
      EXPECT_LE(exit_s, last_s + 1e-5) << decay << " " << room;
      EXPECT_LE(exit_s, signal.envelope_time_s(tolerance) * (1 + 1e-9)) << decay << " " << room;
    }
  }
}

TEST(PositioningTime, OfPositionUsesTheDeviation) {
  const auto input = input_of(plan_profile(indexing(375, 14000, 13500, 82.5)).value());
  const Settling settling = settle(fit_b(), input, {BandOf::position, 1e-3}).value();
  ASSERT_GT(settling.positioning_time_s, settling.access_time_s);
  EXPECT_NEAR(std::abs(carried_at(fit_b(), input, settling.positioning_time_s).deviation_mm), 1e-3, 1e-12);
  EXPECT_FALSE(settle(fit_b(), input, {BandOf::position, 0}));
}

TEST(ServoInput, QuantisedConvergesToTheProfileAndKeepsItsStroke) {
  const Profile profile = plan_profile(indexing(375, 14000, 13500, 82.5)).value();
  const double exact = settle(fit_b(), input_of(profile), test::kPublishedBand).value().positioning_time_s;
  double error_before = 1;
  for (const double update_us : {250.0, 25.0, 2.5}) {
    const auto input = quantised_input_of(profile, update_us).value();
    const double error = std::abs(settle(fit_b(), input, test::kPublishedBand).value().positioning_time_s - exact);
    EXPECT_LT(error, error_before);
    error_before = error;
    double velocity = 0;
    for (const InputJump& jump : input) {
      velocity += jump.acceleration_jump_mm_s2 * (input.back().time_s - jump.time_s);
    }
    EXPECT_NEAR(velocity, 0, 1e-6);
  }
  EXPECT_LT(error_before, 5e-6);
}

TEST(ServoInput, DelayedMovesEverythingByTheDelay) {
  const auto input = input_of(plan_profile(indexing(375, 14000, 13500, 82.5)).value());
  const Settling on_time = settle(fit_b(), input, test::kPublishedBand).value();
  const Settling late = settle(fit_b(), delayed(input, 0.5e-3), test::kPublishedBand).value();
  EXPECT_NEAR(late.positioning_time_s, on_time.positioning_time_s + 0.5e-3, 1e-12);
}

}  // namespace
}  // namespace gravure::motion
