#include <gtest/gtest.h>

#include <algorithm>

#include "gravure/motion/plan_profile.hpp"
#include "motion_test_support.hpp"

namespace gravure::motion {
namespace {

using test::Random;

/// The end of segment k by its own polynomial.
State end_of_segment(const Profile& p, std::size_t k) {
  const double h = p.durations_s[k];
  return {p.position_mm[k] + h * (p.velocity_mm_s[k] + h * (p.acceleration_mm_s2[k] / 2 + h * p.jerk_mm_s3[k] / 6)),
          p.velocity_mm_s[k] + h * (p.acceleration_mm_s2[k] + h * p.jerk_mm_s3[k] / 2),
          p.acceleration_mm_s2[k] + h * p.jerk_mm_s3[k], p.jerk_mm_s3[k]};
}

/// Largest mismatch at the segment borders and at the target, relative to what the move handles.
std::string continuity_fault(const Profile& p, double v_scale, bool has_jerk) {
  const double x_scale = std::abs(p.stroke_mm) + v_scale * p.access_time_s();
  const double a_scale = std::max(p.peak_acceleration_up_mm_s2, p.peak_acceleration_down_mm_s2);
  for (std::size_t k = 0; k < 7; ++k) {
    if (p.durations_s[k] < 0) {
      return "time falls";
    }
    const State end = end_of_segment(p, k);
    const double x = k < 6 ? p.position_mm[k + 1] : p.stroke_mm;
    const double v = k < 6 ? p.velocity_mm_s[k + 1] : p.end_velocity_mm_s;
    const double a = k < 6 ? p.acceleration_mm_s2[k + 1] : 0;
    if (!(std::abs(end.position_mm - x) <= 1e-12 * x_scale)) {
      return "position jumps";
    }
    if (!(std::abs(end.velocity_mm_s - v) <= 1e-12 * v_scale)) {
      return "velocity jumps";
    }
    // A segment of no duration after rounding may carry the acceleration of a denormal ramp.
    if (has_jerk && !(std::abs(end.acceleration_mm_s2 - a) <= 1e-9 * a_scale)) {
      return "acceleration jumps";
    }
  }
  return "";
}

std::string limit_fault(const Profile& p, const Move& m, double jerk_up, double jerk_down, int samples) {
  constexpr double kSlack = 1 + 1e-12;
  const double direction = m.stroke_mm < 0 ? -1 : 1;
  for (int i = 0; i <= samples; ++i) {
    const State s = p.at(p.access_time_s() * i / samples);
    const double along = direction * s.acceleration_mm_s2;
    if (std::abs(s.velocity_mm_s) > m.v_max_mm_s * kSlack) {
      return "velocity beyond its limit";
    }
    if (along > m.a_up_mm_s2 * kSlack || along < -m.a_down_mm_s2 * kSlack) {
      return "acceleration beyond its limit";
    }
    // Where the acceleration starts or ends either limit may hold.
    const double up = along > 1e-9 * m.a_up_mm_s2 ? jerk_up : 0;
    const double down = along < -1e-9 * m.a_down_mm_s2 ? jerk_down : 0;
    const double jerk = up + down > 0 ? up + down : std::max(jerk_up, jerk_down);
    if (std::abs(s.jerk_mm_s3) > jerk * kSlack) {
      return "jerk beyond its limit";
    }
  }
  return "";
}

JerkRequest random_request(Random& random, bool moving_ends) {
  JerkRequest r;
  r.move.stroke_mm = random.log_between(1e-9, 1e6) * (random.uniform() < 0.5 ? -1 : 1);
  r.move.v_max_mm_s = random.log_between(1e-2, 1e5);
  r.move.a_up_mm_s2 = random.log_between(1, 1e7);
  r.move.a_down_mm_s2 = random.log_between(1, 1e7);
  r.jerk_up_mm_s3 = random.log_between(10, 1e10);
  r.jerk_down_mm_s3 = random.log_between(10, 1e10);
  if (moving_ends) {
    r.move.start_velocity_mm_s = random.between(-1, 1) * r.move.v_max_mm_s;
    r.move.end_velocity_mm_s = random.between(-1, 1) * r.move.v_max_mm_s;
  }
  return r;
}

std::string fault_of(const JerkRequest& request, const Profile& profile) {
  std::string fault = continuity_fault(profile, request.move.v_max_mm_s, true);
  if (fault.empty()) {
    fault = limit_fault(profile, request.move, request.jerk_up_mm_s3, request.jerk_down_mm_s3, 8);
  }
  return fault;
}

testing::Message describe(const JerkRequest& r) {
  return testing::Message() << "stroke " << r.move.stroke_mm << " v " << r.move.v_max_mm_s << " a " << r.move.a_up_mm_s2
                            << " " << r.move.a_down_mm_s2 << " j " << r.jerk_up_mm_s3 << " " << r.jerk_down_mm_s3
                            << " from " << r.move.start_velocity_mm_s << " to " << r.move.end_velocity_mm_s;
}

TEST(JerkLimited, IsContinuousWithinLimitsExactAndNotSlowerThanSymmetricOverAMillionMoves) {
  GRAVURE_TRACE_SEED();
  Random random(test::seed());
  for (int trial = 0; trial < 1'000'000; ++trial) {
    const JerkRequest request = random_request(random, trial % 2 == 1);
    const auto profile = plan_profile(request);
    ASSERT_TRUE(profile) << profile.error().message;
    ASSERT_EQ(fault_of(request, profile.value()), "") << describe(request) << " trial " << trial;
    ASSERT_EQ(profile.value().at(profile.value().access_time_s()).position_mm, request.move.stroke_mm);
    JerkRequest symmetric = request;
    symmetric.move.a_up_mm_s2 = symmetric.move.a_down_mm_s2 =
        std::min(request.move.a_up_mm_s2, request.move.a_down_mm_s2);
    symmetric.jerk_up_mm_s3 = symmetric.jerk_down_mm_s3 = std::min(request.jerk_up_mm_s3, request.jerk_down_mm_s3);
    ASSERT_LE(profile.value().access_time_s(), plan_profile(symmetric).value().access_time_s() * (1 + 1e-12))
        << describe(request);
  }
}

TEST(SFactor, IsContinuousWithinLimitsExactAndNotSlowerThanSymmetricOverAMillionMoves) {
  GRAVURE_TRACE_SEED();
  Random random(test::seed() + 1);
  for (int trial = 0; trial < 1'000'000; ++trial) {
    const JerkRequest drawn = random_request(random, trial % 2 == 1);
    SFactorRequest request{drawn.move, trial % 16 == 0 ? 0.0 : random.log_between(0.1, 1000), 250};
    const auto profile = plan_profile(request);
    ASSERT_TRUE(profile) << profile.error().message;
    ASSERT_EQ(continuity_fault(profile.value(), request.move.v_max_mm_s, request.s_factor > 0), "")
        << describe(drawn) << " S " << request.s_factor << " trial " << trial;
    ASSERT_EQ(limit_fault(profile.value(), request.move, 1e300, 1e300, 8), "") << describe(drawn);
    if (trial % 2 == 0) {
      request.move.a_up_mm_s2 = request.move.a_down_mm_s2 = std::min(drawn.move.a_up_mm_s2, drawn.move.a_down_mm_s2);
      ASSERT_LE(profile.value().access_time_s(), plan_profile(request).value().access_time_s() * (1 + 1e-12))
          << describe(drawn);
    }
  }
}

TEST(JerkLimited, BreachesNoLimitAtAThousandInstants) {
  GRAVURE_TRACE_SEED();
  Random random(test::seed() + 2);
  for (int trial = 0; trial < 1000; ++trial) {
    const JerkRequest request = random_request(random, trial % 2 == 1);
    const Profile profile = plan_profile(request).value();
    ASSERT_EQ(limit_fault(profile, request.move, request.jerk_up_mm_s3, request.jerk_down_mm_s3, 1000), "")
        << describe(request);
  }
}

// Swapping the limits and the ends runs the same move backwards.
TEST(JerkLimited, TakesTheSameTimeBackwards) {
  GRAVURE_TRACE_SEED();
  Random random(test::seed() + 3);
  for (int trial = 0; trial < 100'000; ++trial) {
    const JerkRequest there = random_request(random, trial % 2 == 1);
    JerkRequest back = there;
    std::swap(back.move.a_up_mm_s2, back.move.a_down_mm_s2);
    std::swap(back.jerk_up_mm_s3, back.jerk_down_mm_s3);
    std::swap(back.move.start_velocity_mm_s, back.move.end_velocity_mm_s);
    const double time = plan_profile(there).value().access_time_s();
    ASSERT_NEAR(plan_profile(back).value().access_time_s(), time, 1e-12 * time) << describe(there);
  }
}

// Two ramps and a cruise at a thousand velocities: whatever reaches the target there takes as long or longer.
TEST(JerkLimited, IsNotBeatenByAnyCruiseVelocityOnAGrid) {
  GRAVURE_TRACE_SEED();
  Random random(test::seed() + 4);
  for (int trial = 0; trial < 2000; ++trial) {
    JerkRequest request = random_request(random, trial % 2 == 1);
    request.move.stroke_mm = random.log_between(1e-3, 1e3);
    const double best = plan_profile(request).value().access_time_s();
    const auto ramp_s = [&request](double from, double to) {
      const double a = to > from ? request.move.a_up_mm_s2 : request.move.a_down_mm_s2;
      const double j = to > from ? request.jerk_up_mm_s3 : request.jerk_down_mm_s3;
      const double u = std::abs(to - from);
      return u * j >= a * a ? u / a + a / j : 2 * std::sqrt(u / j);
    };
    const double v0 = request.move.start_velocity_mm_s;
    const double v1 = request.move.end_velocity_mm_s;
    for (int k = -500; k <= 500; ++k) {
      const double v = request.move.v_max_mm_s * k / 500;
      const double t0 = ramp_s(v0, v);
      const double t1 = ramp_s(v, v1);
      const double left = request.move.stroke_mm - (v0 + v) / 2 * t0 - (v + v1) / 2 * t1;
      if (v != 0 && left / v >= 0) {
        ASSERT_GE(t0 + t1 + left / v, best * (1 - 1e-9)) << describe(request) << " cruising at " << v;
      }
    }
  }
}

}  // namespace
}  // namespace gravure::motion
