#include "gravure/texture/following_error.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "dice.hpp"
#include "gravure/core/path_expand.hpp"

namespace gravure::texture {
namespace {

using gravure::test::Dice;
using kinematics::Vector3;

constexpr double kServo_s = 50e-6;

/// Axes as a function of time.
class Given final : public PathMotion {
 public:
  using Axes = std::array<double, kPathAxes.size()>;
  Given(std::int64_t instants, std::function<Axes(double)> axes) : instants_(instants), axes_(std::move(axes)) {}
  std::int64_t instants() const noexcept override { return instants_; }
  Result<void> read(std::int64_t first, std::span<PathInstant> out) const override {
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k].axes = axes_(static_cast<double>(first + static_cast<std::int64_t>(k)) * kServo_s);
    }
    return {};
  }

 private:
  std::int64_t instants_;
  std::function<Axes(double)> axes_;
};

AxesServos all_loops(const ServoLoop& loop) {
  return AxesServos(kPathAxes.size(), loop);
}

Given all_axes(std::int64_t instants, const std::function<double(double)>& position) {
  return {instants, [position](double time_s) {
            Given::Axes axes;
            axes.fill(position(time_s));
            return axes;
          }};
}

class EveryDamping : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Dampings, EveryDamping, testing::Values(0.3, 0.7, 1 - 1e-9, 1.0, 1 + 1e-9, 3.0));

/// 2 zeta v / omega, once what the start has stirred has died away.
TEST_P(EveryDamping, TrailsARampByTheSteadyLag) {
  const ServoLoop loop{40, GetParam()};
  const double v = 25;
  // A ramp that gets up to speed in half a second, so slowly that nothing overshoots.
  const auto ramp = [v](double t) {
    const double s = std::min(t / 0.5, 1.0);
    return t < 0.5 ? v * 0.5 * (s * s * s - s * s * s * s / 2) : v * (t - 0.25);
  };
  const auto errors = predict_following(all_axes(40'000, ramp), all_loops(loop), {}, kServo_s, {});
  ASSERT_TRUE(errors);
  const double lag = 2 * loop.damping * v / (2 * std::numbers::pi * loop.natural_hz);
  for (const FollowingError& axis : errors.value().axes) {
    EXPECT_NEAR(axis.max, lag, 1e-3 * lag);
    EXPECT_GT(static_cast<double>(axis.instant) * kServo_s, 0.4);
  }
}

/// |(2 zeta omega i W - W^2) / (omega^2 + 2 zeta omega i W - W^2)| of the amplitude, rms over root two.
TEST_P(EveryDamping, FollowsASineAsItsTransferFunctionSays) {
  const ServoLoop loop{60, GetParam()};
  const double omega = 2 * std::numbers::pi * loop.natural_hz;
  const double wave = 2 * std::numbers::pi * 20;
  const double amplitude = 0.8;
  const auto sine = [wave, amplitude](double t) {
    const double s = std::min(t / 0.6, 1.0);
    return amplitude * s * s * s * (10 - 15 * s + 6 * s * s) * std::sin(wave * t);
  };
  const std::complex<double> drag(-wave * wave, 2 * loop.damping * omega * wave);
  const double behind = amplitude * std::abs(drag / (omega * omega + drag));
  const auto errors = predict_following(all_axes(60'000, sine), all_loops(loop), {}, kServo_s, {});
  ASSERT_TRUE(errors);
  EXPECT_NEAR(errors.value().axes[0].max, behind, 1e-4 * behind);
}

/// Against Runge and Kutta in steps of a hundredth of the period, along the very cubics, for any set-points and loops.
TEST(PredictFollowing, SolvesTheLoopExactlyAlongAnyCubics) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 20; ++trial) {
    constexpr std::size_t kCount = 30;
    std::vector<double> x(kCount);
    for (double& each : x) {
      each = static_cast<double>(dice.between(-1000, 1000)) * 1e-3;
    }
    const ServoLoop loop{static_cast<double>(dice.between(1, 8000)), static_cast<double>(dice.between(1, 400)) * 0.01};
    const Given motion = all_axes(kCount, [&x](double t) { return x[static_cast<std::size_t>(t / kServo_s + 0.5)]; });
    const auto errors = predict_following(motion, all_loops(loop), {}, kServo_s, {});
    ASSERT_TRUE(errors);
    const double w = 2 * std::numbers::pi * loop.natural_hz * kServo_s;
    double y = x[0];
    double rate = 0;
    double most = 0;
    for (std::size_t k = 0; k + 1 < kCount; ++k) {
      const std::array<double, 4> four{x[k > 0 ? k - 1 : 0], x[k], x[k + 1], x[std::min(k + 2, kCount - 1)]};
      const auto pull = [&](double share, double at, double speed) {
        return w * w * (cubic_between(four, share) - at) - 2 * loop.damping * w * speed;
      };
      constexpr int kSteps = 100;
      constexpr double kStep = 1.0 / kSteps;
      for (int i = 0; i < kSteps; ++i) {
        const double s = i * kStep;
        const double a1 = pull(s, y, rate);
        const double v2 = rate + a1 * kStep / 2;
        const double a2 = pull(s + kStep / 2, y + rate * kStep / 2, v2);
        const double v3 = rate + a2 * kStep / 2;
        const double a3 = pull(s + kStep / 2, y + v2 * kStep / 2, v3);
        const double v4 = rate + a3 * kStep;
        const double a4 = pull(s + kStep, y + v3 * kStep, v4);
        y += kStep / 6 * (rate + 2 * v2 + 2 * v3 + v4);
        rate += kStep / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
      }
      most = std::max(most, std::abs(x[k + 1] - y));
    }
    EXPECT_NEAR(errors.value().axes[3].max, most, 1e-6 * most) << loop.natural_hz << " Hz, damping " << loop.damping;
  }
}

/// Axes behind by a little put the light where kinematics with those axes puts it.
TEST(PredictFollowing, KnowsWhereTheSpotGoes) {
  const ServoLoop soft{20, 1};
  const ServoLoop stiff{1e6, 1};
  const double v = 0.01;
  for (const double sense : {-1.0, 1.0}) {
    for (std::size_t moved = 0; moved < kPathAxes.size(); ++moved) {
      AxesServos servos = all_loops(stiff);
      servos[moved] = soft;
      const Given::Axes from{3, -4, 5, 0.3, 1.1, 0.5, -0.2, 0.4};
      const auto axes_at = [&](double time_s) {
        Given::Axes axes = from;
        axes[moved] += v * time_s;
        return axes;
      };
      RotaryTable table;
      table.sense = sense;
      const auto errors = predict_following(Given(20'000, axes_at), servos, table, kServo_s, {});
      ASSERT_TRUE(errors);
      const double end_s = static_cast<double>(errors.value().spot_mm.instant) * kServo_s;
      const Given::Axes ordered = axes_at(end_s);
      Given::Axes real = ordered;
      real[moved] -= 2 * v / (2 * std::numbers::pi * soft.natural_hz);
      // The point that the orders light up, seen from the head with the axes where they are.
      const Vector3 light(ordered[0] + ordered[5], ordered[1] + ordered[6], ordered[2] + ordered[7]);
      Eigen::Matrix3d turn;
      for (int k = 0; k < 3; ++k) {
        turn.col(k) = table.turned(ordered[3], ordered[4], Vector3::Unit(k));
      }
      const Vector3 there = table.turned(real[3], real[4], turn.transpose() * light);
      const Vector3 off = Vector3(real[0] + real[5], real[1] + real[6], real[2] + real[7]) - there;
      EXPECT_NEAR(errors.value().spot_mm.max, off.head<2>().norm(), 1e-7) << kPathAxes[moved];
      EXPECT_NEAR(errors.value().focus_mm.max, std::abs(off.z()), 1e-7) << kPathAxes[moved];
    }
  }
}

TEST(PredictFollowing, RefusesLoopsThatAreNone) {
  const Given still = all_axes(10, [](double) { return 1.0; });
  AxesServos servos = assumed_servos();
  const auto none = predict_following(still, servos, {}, kServo_s, {});
  ASSERT_TRUE(none);
  EXPECT_EQ(none.value().spot_mm.max, 0);
  for (const ServoLoop& wrong : {ServoLoop{0, 1}, ServoLoop{-5, 1}, ServoLoop{2e6, 1}, ServoLoop{50, 0},
                                 ServoLoop{50, 101}, ServoLoop{std::nan(""), 1}}) {
    servos[4] = wrong;
    const auto refused = predict_following(still, servos, {}, kServo_s, {});
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
    EXPECT_NE(refused.error().message.find("axis C"), std::string::npos);
  }
  EXPECT_EQ(assumed_servos(true).size(), kPathAxes.size());
  for (const std::size_t axes : {0U, 6U, 9U}) {
    EXPECT_EQ(predict_following(still, AxesServos(axes, ServoLoop{50, 1}), {}, kServo_s, {}).error().code,
              ErrorCode::bad_argument);
  }
}

}  // namespace
}  // namespace gravure::texture
