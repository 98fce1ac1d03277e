#include <gtest/gtest.h>

#include <cmath>

#include "gravure/core/board_runs.hpp"
#include "gravure/core/spin_phase.hpp"
#include "gravure/formats/plan_json.hpp"
#include "sync_support.hpp"

namespace gravure {
namespace {

using sync_test::planned;
using sync_test::Random;
using sync_test::roller_job;
using sync_test::seed_note;
using sync_test::tube_job;

AxisLimits limits(const Rational& speed, const Rational& acceleration, const Rational& jerk) {
  return {speed, acceleration, jerk};
}

Job spun_roller() {
  Job job = roller_job();
  job.rotary.limits = limits(90, 20, 100);  // it turns at 6.7 deg/s
  job.rotary.start_angle_deg = 30;
  return job;
}

Integer edge_of(const AbPlan& ab) {
  return Integer(1) << static_cast<unsigned>(ab.counter_bits - 2);
}

/// Counts of a schedule, a seed clock's steps at a time in whole numbers; the fraction runs through.
Integer counts_of(const AbPlan& ab, const std::vector<SpinSegment>& segments, std::int64_t ticks_per_seed) {
  Integer counts = 0;
  Integer ticks = 0;
  for (const SpinSegment& segment : segments) {
    counts += Integer(segment.increment) * (Integer(segment.seeds) * ticks_per_seed / Integer(ab.prescaler));
    ticks += Integer(segment.seeds) * ticks_per_seed;
  }
  return counts + ticks / Integer(ab.prescaler) * Integer(ab.fraction_num) / Integer(ab.fraction_den);
}

void expect_rising(const SpinPlan& up, const AbPlan& ab) {
  std::uint64_t before = 0;
  for (const SpinSegment& segment : up.segments) {
    EXPECT_GE(segment.increment, before);
    EXPECT_LE(segment.increment, ab.increment);
    EXPECT_GE(segment.seeds, 1);
    before = segment.increment;
  }
}

TEST(Spin, EndsOnTheWholeEdgeThatIsNearestToTheStartAngle) {
  SCOPED_TRACE(seed_note());
  Random random;
  for (int trial = 0; trial < 300; ++trial) {
    Job job = random.chance(2) ? roller_job() : tube_job();
    job.rotary.limits = limits(100'000, ratio(random.count(1, 100'000), 7), ratio(random.count(1, 1'000'000), 3));
    job.rotary.start_angle_deg = ratio(random.count(-36'000, 36'000), 100);
    job.rotary.gear_workpiece_turns = random.count(1, 7);
    job.fpga.fractional = random.chance(3);
    job.fpga.clock_multiplier = random.count(1, 3);
    job.rotary.max_ab_hz = 20'000'000;
    const auto made = make_plan(job, 1000, 3);
    if (!made) {
      ASSERT_NE(made.error().message.find("the board counts"), std::string::npos) << made.error().message;
      continue;
    }
    const Plan& plan = made.value();
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    ASSERT_TRUE(plan.spin);
    const SpinPlan& up = plan.spin->up;
    EXPECT_EQ(up.counts, counts_of(plan.ab, up.segments, job.fpga.clock_multiplier));
    EXPECT_LT(up.counts % edge_of(plan.ab), job.fpga.clock_multiplier) << "a whole edge";
    const Rational edge_deg = Rational(360) / plan.rotary.edges_per_revolution;
    EXPECT_EQ(up.travel - plan.spin->start_deg, plan.spin->start_error_deg);
    EXPECT_LE(abs(plan.spin->start_error_deg), edge_deg * ratio(51, 100));
    EXPECT_EQ(denominator_of(Rational((plan.spin->start_deg - job.rotary.start_angle_deg) / 360)), 1);
    EXPECT_LT(Rational(plan.spin->start_deg - 360),
              Rational(Integer(counts_of(plan.ab, up.segments, job.fpga.clock_multiplier))));
    expect_rising(up, plan.ab);
    EXPECT_EQ(up.ticks % static_cast<std::int64_t>(plan.ab.prescaler), 0);
    EXPECT_EQ(plan.spin->total_s, plan.job.duration_s + up.duration_s + plan.spin->down.duration_s);
    const Result<Plan> again = plan_from_json(plan_to_json(plan));
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(plan_to_json(again.value()), plan_to_json(plan));
  }
}

/// Where a jerk-limited ramp to `speed` stands after `t`, written down for itself.
double ramp_at(double t, double speed, double acceleration, double jerk) {
  const double peak = std::min(acceleration, std::sqrt(speed * jerk));
  const double tj = peak / jerk;
  const double end = speed / peak + tj;
  if (t < tj) {
    return jerk * t * t * t / 6;
  }
  const double v1 = peak * tj / 2;
  const double x1 = peak * tj * tj / 6;
  if (t < end - tj) {
    return x1 + v1 * (t - tj) + peak * (t - tj) * (t - tj) / 2;
  }
  const double left = std::max(0.0, end - t);  // seen from its end it is the same curve backwards
  const double whole = speed * end / 2;
  return whole - speed * left + jerk * left * left * left / 6 + speed * std::max(0.0, t - end);
}

TEST(Spin, FollowsAJerkLimitedRampToAnEdge) {
  for (const double jerk : {10.0, 100.0, 1e6}) {
    Job job = spun_roller();
    job.rotary.limits = limits(90, 20, Rational(jerk));
    const Plan plan = planned(job, 3500, 1);
    ASSERT_TRUE(plan.spin);
    const double speed = 360.0 * to_double(plan.ab.output_hz) * 4 / to_double(plan.rotary.edges_per_revolution);
    const double edge_deg = 360 / to_double(plan.rotary.edges_per_revolution);
    EXPECT_NEAR(to_double(plan.spin->up.max_acceleration), std::min(20.0, std::sqrt(speed * jerk)), 1e-9);
    SpinPhase phase;
    double seconds = 0;
    int compared = 0;
    for (const SpinSegment& segment : plan.spin->up.segments) {
      phase = phase_after(plan.ab, segment.increment, 2 * segment.seeds, phase);
      seconds += static_cast<double>(segment.seeds) / 82e6;
      const double there = to_double(Rational(Rational(phase.counts) / Rational(edge_of(plan.ab)))) * edge_deg;
      ASSERT_NEAR(there, ramp_at(seconds, speed, 20, jerk), 3 * edge_deg) << seconds;
      ++compared;
    }
    EXPECT_GE(compared, 65) << "64 stairs and what fills up";
    EXPECT_LE(to_double(plan.spin->up.speed_error), speed * 2.05 / 64) << "a stair is at most 2 / 64 high";
  }
}

TEST(Spin, GoesDownAsItCameUpAndEndsAtRest) {
  const Plan plan = planned(spun_roller(), 3500, 1);
  const std::vector<SpinSegment>& down = plan.spin->down.segments;
  ASSERT_GE(down.size(), 65U) << "64 stairs and what fills up";
  for (std::size_t i = 1; i < down.size(); ++i) {
    EXPECT_LE(down[i].increment, down[i - 1].increment);
  }
  EXPECT_LT(down.back().increment, plan.ab.increment / 32);
  EXPECT_EQ(plan.spin->down.counts, counts_of(plan.ab, down, 2));
}

/// Counts from rest to rest, in whole numbers; the fraction runs through.
Integer rest_of(const Plan& plan, const AbPlan& ab, const AxisSpin& spin) {
  std::vector<SpinSegment> all = spin.up.segments;
  const std::int64_t ticks_per_seed = plan.clock.fpga_hz / plan.clock.seed_hz;
  all.push_back({ab.increment, run_with(plan, 0).ticks / ticks_per_seed});
  all.insert(all.end(), spin.down.segments.begin(), spin.down.segments.end());
  return counts_of(ab, all, ticks_per_seed);
}

/// On an A-B period, or less than the steps of a seed clock beyond it; never faster than marking, never faster again.
void expect_rest_on_a_period(const Plan& plan, const AbPlan& ab, const AxisSpin& spin) {
  EXPECT_LT(rest_of(plan, ab, spin) % (4 * edge_of(ab)), 2 * plan.clock.fpga_hz / plan.clock.seed_hz);
  std::uint64_t before = ab.increment;
  for (const SpinSegment& segment : spin.down.segments) {
    EXPECT_LE(segment.increment, before);
    before = segment.increment;
  }
  EXPECT_TRUE(plan_from_json(plan_to_json(plan)));
}

TEST(Spin, RestsOnAnAbPeriodAfterEveryBandWholeTurnsOn) {
  SCOPED_TRACE(seed_note());
  Random random;
  int banded = 0;
  for (int trial = 0; trial < 120; ++trial) {
    Job job = tube_job();
    job.rotary.limits = limits(100'000, ratio(random.count(100, 100'000), 7), ratio(random.count(1000, 1'000'000), 3));
    job.rotary.start_angle_deg = ratio(random.count(-36'000, 36'000), 100);
    job.rotary.gear_workpiece_turns = random.count(1, 7);
    job.rotary.max_ab_hz = 20'000'000;
    job.fpga.fractional = random.chance(2);
    job.fpga.clock_multiplier = random.count(1, 3);
    if (random.chance(2)) {
      job.scanner.field_mm = ratio(8 * 300 + 7, 1000);
    }
    const auto made = make_plan(job, 1000, 3);
    if (!made) {
      ASSERT_NE(made.error().message.find("the board"), std::string::npos) << made.error().message;
      continue;
    }
    const Plan& plan = made.value();
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    expect_rest_on_a_period(plan, plan.ab, *plan.spin);
    if (plan.bands) {
      ++banded;
      const Rational edges = Rational(Integer(rest_of(plan, plan.ab, *plan.spin) / edge_of(plan.ab)));
      EXPECT_EQ(denominator_of(Rational(edges / plan.rotary.edges_per_revolution)), 1) << "the encoder index again";
      EXPECT_EQ(plan.spin->total_s, plan.job.duration_s + (plan.spin->up.duration_s + plan.spin->down.duration_s) *
                                                              Rational(plan.bands->count));
    }
  }
  EXPECT_GT(banded, 20);
}

TEST(Spin, IsLeftOutWhereALimitIsMissing) {
  const std::string plain = plan_to_json(planned(roller_job(), 3500, 1));
  Job job = spun_roller();
  job.rotary.start_angle_deg = 0;
  job.rotary.limits.max_jerk.reset();
  Plan without = planned(job, 3500, 1);
  ASSERT_FALSE(without.warnings.empty());
  EXPECT_EQ(without.warnings.back().find("rotary.max_jerk_deg_s3: missing"), 0U) << without.warnings.back();
  without.warnings.pop_back();
  EXPECT_EQ(plan_to_json(without), plain);
  job.rotary.start_angle_deg = 5;
  const Plan plan = planned(job, 3500, 1);
  EXPECT_FALSE(plan.spin);
  ASSERT_GE(plan.warnings.size(), 2U);
  const std::string& no_start = plan.warnings[plan.warnings.size() - 2];
  EXPECT_NE(no_start.find("start_angle_deg = 5 has no effect"), std::string::npos) << no_start;
}

TEST(Spin, RefusesMarkingFasterThanTheAxisMay) {
  Job job = roller_job();
  job.rotary.limits.max_speed = 5;  // that alone is enough to be checked
  const auto plan = make_plan(job, 3500, 1);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::out_of_range);
  EXPECT_NE(plan.error().message.find("rotary.max_speed_deg_s = 5: marking moves the axis at 6.7"), std::string::npos)
      << plan.error().message;
}

TEST(Spin, RefusesAStartThatTheBoardCannotWaitFor) {
  Job job = spun_roller();
  job.rotary.start_angle_deg = 0;  // a whole turn takes 53.7 s
  const auto plan = make_plan(job, 3500, 1);
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().message.find("rotary.start_angle_deg = 0: the spin-up takes 53.99"), std::string::npos)
      << plan.error().message;
  EXPECT_NE(plan.error().message.find("the board counts 52.37"), std::string::npos) << plan.error().message;
}

Job helical_job() {
  Job job = tube_job();
  job.mode = Mode::helical;
  job.carriage = {16, 4, 20, 8, 20'000'000, limits(500, 100, 5000)};
  job.rotary.limits = limits(100'000, 5000, 50'000);
  return job;
}

TEST(Spin, BringsBothAxesOfAHelicalJobToTickZeroAtOnce) {
  for (const bool fractional : {false, true}) {
    for (const int slow : {1, 3000}) {
      Job job = helical_job();
      job.fpga.fractional = fractional;
      job.carriage.limits.max_acceleration = ratio(100, slow);
      const Plan plan = planned(job, 500, 4);
      ASSERT_TRUE(plan.spin);
      ASSERT_TRUE(plan.carriage && plan.carriage->spin);
      const SpinPlan& carriage = plan.carriage->spin->up;
      EXPECT_EQ(plan.spin->up.ticks, carriage.ticks);
      EXPECT_EQ(carriage.counts, counts_of(plan.carriage->ab, carriage.segments, 2));
      EXPECT_LT(carriage.counts % edge_of(plan.carriage->ab), 2);
      EXPECT_EQ((slow > 1 ? plan.spin->up : carriage).segments.front().increment, 0U) << "who needs less waits";
      const Result<Plan> again = plan_from_json(plan_to_json(plan));
      ASSERT_TRUE(again) << again.error().message;
    }
  }
}

TEST(Spin, CountsForEveryPassOfAStage) {
  Job job = roller_job();
  job.mode = Mode::flat;
  job.stage = {5000, 8, 20, 8, 2'000'000, limits(100, 500, 10'000)};
  const Plan plan = planned(job, 3500, 6);
  ASSERT_TRUE(plan.spin);
  EXPECT_EQ(plan.spin->total_s, plan.job.duration_s + 6 * (plan.spin->up.duration_s + plan.spin->down.duration_s));
  EXPECT_EQ(plan.spin->up.counts % edge_of(plan.ab), 0);
  ASSERT_TRUE(plan_from_json(plan_to_json(plan)));
}

TEST(Spin, RestsAfterAPassWhereTheWayBackBegins) {
  SCOPED_TRACE(seed_note());
  Random random;
  for (int trial = 0; trial < 200; ++trial) {
    Job job = roller_job();
    job.mode = Mode::flat;
    job.fpga.fractional = random.chance(2);
    job.fpga.clock_multiplier = random.count(1, 3);
    job.stage = {random.count(2, 6000),
                 ratio(random.count(20, 120), 7),
                 20,
                 static_cast<int>(random.count(0, 9)),
                 20'000'000,
                 limits(1000, ratio(random.count(100, 100'000), 7), random.count(1000, 1'000'000))};
    const auto made = make_plan(job, 3500, 2);
    ASSERT_TRUE(made) << made.error().message;
    const Plan& plan = made.value();
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    expect_rest_on_a_period(plan, plan.ab, *plan.spin);
    // Back from there by the same spin-up, the first line of the way back begins where the last one of the pass ended.
    const Integer up = plan.spin->up.counts / edge_of(plan.ab);
    const Integer rest = rest_of(plan, plan.ab, *plan.spin) / edge_of(plan.ab);
    EXPECT_LE(abs(Rational(Rational(Integer(rest - 2 * up)) - plan.rotary.edges_per_revolution)), 1);
  }
}

TEST(Spin, InAPlanThatContradictsItselfIsRefused) {
  const Plan plan = planned(spun_roller(), 3500, 1);
  const auto refuses = [&](const auto& change, const std::string& part) {
    Plan wrong = plan;
    change(*wrong.spin);
    const Result<Plan> read = plan_from_json(plan_to_json(wrong));
    ASSERT_FALSE(read) << part;
    EXPECT_NE(read.error().message.find(part), std::string::npos) << read.error().message;
  };
  refuses([](AxisSpin& spin) { spin.up.counts += 1; }, "spin.up.counts");
  refuses([](AxisSpin& spin) { spin.up.segments[9].increment += 1; }, "spin.up.counts");
  refuses([](AxisSpin& spin) { spin.up.segments.back().seeds += 1; }, "spin.up.");
  refuses([](AxisSpin& spin) { spin.up.segments.back().increment = ~std::uint64_t{0} >> 3U; }, "faster than marking");
  refuses([](AxisSpin& spin) { spin.down.ticks += 2; }, "spin.down.ticks");
  refuses([](AxisSpin& spin) { spin.up.travel += 1; }, "spin.up.travel");
  refuses([](AxisSpin& spin) { spin.start_error_deg = 0; }, "spin.start_error_deg");
  refuses([](AxisSpin& spin) { spin.total_s += 1; }, "spin.total_s");
  refuses([](AxisSpin& spin) { spin.down.segments.clear(); }, "spin.down.segments are none");
}

}  // namespace
}  // namespace gravure
