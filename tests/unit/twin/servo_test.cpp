#include "servo.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace gravure::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Axis {
  double position = 0;
  double speed = 0;
};

/// x'' = w^2 (command - x) - 2 zeta w x', by the classical Runge-Kutta method.
void integrate(Axis& axis, double omega, double zeta, double from_s, double to_s, int steps,
               const std::function<double(double)>& command) {
  const double h = (to_s - from_s) / steps;
  const auto slope = [&](const Axis& at, double t) {
    return Axis{at.speed, omega * omega * (command(t) - at.position) - 2 * zeta * omega * at.speed};
  };
  const auto moved = [](const Axis& a, const Axis& k, double by) {
    return Axis{a.position + by * k.position, a.speed + by * k.speed};
  };
  for (int i = 0; i < steps; ++i) {
    const double t = from_s + i * h;
    const Axis k1 = slope(axis, t);
    const Axis k2 = slope(moved(axis, k1, h / 2), t + h / 2);
    const Axis k3 = slope(moved(axis, k2, h / 2), t + h / 2);
    const Axis k4 = slope(moved(axis, k3, h), t + h);
    axis.position += h / 6 * (k1.position + 2 * k2.position + 2 * k3.position + k4.position);
    axis.speed += h / 6 * (k1.speed + 2 * k2.speed + 2 * k3.speed + k4.speed);
  }
}

TEST(Servo, FollowsARampLateByTwoZetaSpeedOverOmega) {
  for (const double zeta : {0.2, 0.7, 1.0, 1.8}) {
    const double omega = 2 * kPi * 30;
    const double period = 1e-3;
    Axis axis;
    const double end = 1.0;
    integrate(axis, omega, zeta, 0, end, 20'000, [&](double t) { return t / period; });
    const Servo servo(30, zeta, period);
    EXPECT_NEAR(end / period - axis.position, 2 * zeta / omega / period, 1e-6) << zeta;
    EXPECT_NEAR(servo.ramp_lag_edges(), 2 * zeta / omega / period, 1e-12) << zeta;
  }
}

TEST(Servo, RespondsToAStaircaseAsTheEquationOfMotionDoes) {
  const double hz = 40;
  for (const double zeta : {0.05, 0.3, 0.7, 1.0, 1.00003, 2.5}) {
    for (const double period : {0.3e-3, 4e-3, 60e-3}) {
      const double omega = 2 * kPi * hz;
      const Servo servo(hz, zeta, period);
      Axis axis;
      const double slowest = zeta < 1 ? zeta * omega : omega / (2 * zeta);
      const int edges = static_cast<int>(std::ceil(22 / slowest / period)) + 1;  // e^-22: nothing is left of the start
      for (int edge = 1; edge <= edges; ++edge) {
        integrate(axis, omega, zeta, 0, period, 20 + static_cast<int>(omega * period * 200),
                  [edge](double) { return edge; });
      }
      for (int part = 0; part <= 4; ++part) {  // after one more edge
        const double share = part / 4.0;
        const double behind = edges + 1 - axis.position;
        ASSERT_NEAR(servo.staircase_lag_edges(share), behind, 1e-4 * (1 + servo.ramp_lag_edges()))
            << "damping " << zeta << ", period " << period << ", share " << share;
        integrate(axis, omega, zeta, 0, period / 4, 20 + static_cast<int>(omega * period * 200),
                  [edges](double) { return edges + 1; });
      }
    }
  }
}

TEST(Servo, OfManyEdgesInItsBandwidthIsBehindByTheRampAndHalfAnEdge) {
  const Servo servo(50, 0.7, 1e-6);
  const Servo::Range range = servo.staircase_range();
  EXPECT_NEAR(range.least, servo.ramp_lag_edges() + 0.5, 1e-3);
  EXPECT_NEAR(range.most, servo.ramp_lag_edges() + 0.5, 1e-3);
}

TEST(Servo, RangeHoldsEveryShareAndIsReached) {
  for (const double zeta : {0.02, 0.7, 1.0, 5.0}) {
    for (const double period : {1e-5, 3e-3, 0.08, 2.0}) {
      const Servo servo(25, zeta, period);
      const Servo::Range range = servo.staircase_range();
      double least = 1e300;
      double most = -1e300;
      for (int i = 0; i <= 10'007; ++i) {
        const double share = i / 10'007.0;
        const double lag = share + servo.staircase_lag_edges(share);
        ASSERT_GE(lag, range.least) << zeta << " " << period;
        ASSERT_LE(lag, range.most) << zeta << " " << period;
        least = std::min(least, lag);
        most = std::max(most, lag);
      }
      EXPECT_NEAR(least, range.least, 2e-2) << zeta << " " << period;
      EXPECT_NEAR(most, range.most, 2e-2) << zeta << " " << period;
    }
  }
}

TEST(Servo, StepVariationCountsEveryOvershoot) {
  EXPECT_EQ(Servo(10, 1.5, 1).step_variation(), 1);
  const double overshoot = std::exp(-kPi * 0.5 / std::sqrt(0.75));
  EXPECT_NEAR(Servo(10, 0.5, 1).step_variation(), (1 + overshoot) / (1 - overshoot), 1e-12);
}

}  // namespace
}  // namespace gravure::test
