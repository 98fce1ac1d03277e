#include "spin_ramp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "gravure/core/spin_phase.hpp"
#include "gravure/motion/plan_profile.hpp"

namespace gravure::sync_plan {
namespace {

constexpr std::int64_t kMostSegmentSeeds = 4'294'967'295;  // of a segment: the board's schedule_seeds

Integer counts_per_edge(const AbPlan& ab) {
  return Integer(1) << static_cast<unsigned>(ab.counter_bits - 2);
}

/// The shortest stretch of whole steps of the prescaler and whole seed clocks.
struct Unit {
  std::int64_t seeds = 1;
  std::int64_t steps = 1;
};

Unit unit_of(const SpinRequest& request) {
  const std::uint64_t both = std::gcd(request.ab.prescaler, static_cast<std::uint64_t>(request.ticks_per_seed));
  return {static_cast<std::int64_t>(request.ab.prescaler / both),
          request.ticks_per_seed / static_cast<std::int64_t>(both)};
}

Integer whole(double value) {
  return round_of(Rational(value));
}

void append(std::vector<SpinSegment>& segments, std::uint64_t increment, std::int64_t seeds, std::int64_t unit_seeds) {
  const std::int64_t most = kMostSegmentSeeds / unit_seeds * unit_seeds;
  for (; seeds > 0; seeds -= std::min(seeds, most)) {
    segments.push_back({increment, std::min(seeds, most)});
  }
}

std::int64_t seeds_of(const std::vector<SpinSegment>& segments) {
  std::int64_t seeds = 0;
  for (const SpinSegment& segment : segments) {
    seeds += segment.seeds;
  }
  return seeds;
}

/// What follows from the segments.
void fill(const SpinRequest& request, const Staircase& stairs, SpinPhase before, SpinPlan& spin) {
  const Integer counts = before.counts;
  spin.ticks = seeds_of(spin.segments) * request.ticks_per_seed;
  spin.counts = phase_after(request.ab, spin.segments, request.ticks_per_seed, std::move(before)).counts - counts;
  spin.travel = Rational(spin.counts) / Rational(counts_per_edge(request.ab)) / request.edges_per_unit;
  spin.duration_s = ratio(spin.ticks, request.fpga_hz);
  spin.max_acceleration = Rational(stairs.max_acceleration);
  spin.max_jerk = *request.limits.max_jerk;
  spin.speed_error = Rational(stairs.speed_error);
}

/// Edges of a spin-up, and so of the ramp at the other end of a pass, so that from rest to rest the axis goes whole A-B
/// periods, to an edge, and the spin-down has room for its staircase.
Integer edges_to_turn_back(const SpinRequest& request, const Staircase& stairs, const Integer& least) {
  const AbPlan& ab = request.ab;
  const Rational edge(counts_per_edge(ab));
  const Integer marking = phase_after(ab, ab.increment, request.marking_ticks, {}).counts;
  const Integer down = phase_after(ab, stairs.segments, request.ticks_per_seed, {}).counts;
  const Integer room = ceil_of(Rational(Rational(Integer(marking + down)) / edge - request.edges_per_revolution)) + 2;
  const Integer edges = std::max(least, room);
  const auto off_period = [&](const Integer& up) {
    const Rational way = 2 * Rational(up) + request.edges_per_revolution;
    return Rational(abs(Rational(way - 4 * Rational(round_of(Rational(way / 4))))));
  };
  return off_period(edges + 1) < off_period(edges) ? Integer(edges + 1) : edges;
}

/// The angle where line 0 lies, with as many whole turns as it takes to be `least` or more, in A-B edges: the nearest.
struct StartEdges {
  Rational start_deg = 0;
  Integer edges = 0;
};

StartEdges start_edges(const SpinRequest& request, const Staircase& stairs, const Integer& least) {
  if (request.rest == Rest::turn_back) {
    return {0, edges_to_turn_back(request, stairs, least)};
  }
  if (!request.start_deg) {
    return {0, least};
  }
  const Rational turn = 360;
  const Rational least_deg = Rational(least) / request.edges_per_unit;
  StartEdges start;
  start.start_deg = *request.start_deg + turn * Rational(ceil_of(Rational((least_deg - *request.start_deg) / turn)));
  start.edges = round_of(Rational(start.start_deg * request.edges_per_unit));
  while (start.edges < least) {
    start.start_deg += turn;
    start.edges = round_of(Rational(start.start_deg * request.edges_per_unit));
  }
  return start;
}

/// Where the counter stands at rest after a run, from rest before it: `least` or more.
Integer rest_counts(const SpinRequest& request, const SpinPlan& up, const Integer& least) {
  const Integer edge = counts_per_edge(request.ab);
  const Rational& turn = request.edges_per_revolution;
  switch (request.rest) {
    case Rest::turn_back:
      return 4 * edge * round_of(Rational((2 * Rational(Integer(up.counts / edge)) + turn) / 4));
    case Rest::whole_turns: {
      const Integer turns = denominator_of(Rational(turn / 4));  // so many are whole A-B periods
      const Rational step = Rational(edge) * turn * Rational(turns);
      return floor_of(Rational(step * Rational(ceil_of(Rational(Rational(least) / step)))));
    }
    case Rest::next_period:
      break;
  }
  return (least + 4 * edge - 1) / (4 * edge) * (4 * edge);
}

/// Where the increment goes in a staircase that rises.
void insert_step(std::vector<SpinSegment>& segments, const SpinSegment& step) {
  const auto at = std::find_if(segments.begin(), segments.end(),
                               [&](const SpinSegment& one) { return one.increment >= step.increment; });
  segments.insert(at, step);
}

}  // namespace

Rational marking_speed(const SpinRequest& request) {
  const AbPlan& ab = request.ab;
  const Rational step = Rational(ab.increment) + Rational(Integer(ab.fraction_num), Integer(ab.fraction_den));
  return step / Rational(Integer(ab.prescaler)) * Rational(request.fpga_hz) / Rational(counts_per_edge(ab)) /
         request.edges_per_unit;
}

Result<Staircase> make_staircase(const SpinRequest& request) {
  const double speed = to_double(marking_speed(request));
  const double acceleration = to_double(*request.limits.max_acceleration);
  const double jerk = to_double(*request.limits.max_jerk);
  const double longest_s = speed / acceleration + acceleration / jerk + 2 * std::sqrt(speed / jerk);
  GRAVURE_TRY(const motion::Profile ramp,
              motion::plan_profile(motion::JerkRequest{
                  {2 * speed * longest_s, speed, acceleration, acceleration, 0, speed}, jerk, jerk}));
  const double end_s = ramp.times_s[3];
  const Unit unit = unit_of(request);
  const double unit_s = static_cast<double>(unit.seeds) * static_cast<double>(request.ticks_per_seed) /
                        static_cast<double>(request.fpga_hz);
  if (end_s / unit_s > 0x1p52) {
    return Error{ErrorCode::out_of_range, "the ramp lasts longer than can be counted"};
  }
  const auto units = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(end_s / unit_s)));
  const std::int64_t segments = std::min(units, kSpinSegments);
  const double counts_per_unit = to_double(Rational(Rational(counts_per_edge(request.ab)) * request.edges_per_unit));
  const double top = to_double(Rational(Integer(request.ab.increment)));
  Staircase stairs;
  stairs.max_acceleration = ramp.peak_acceleration_up_mm_s2;
  SpinPhase phase;
  std::uint64_t before = 0;
  std::int64_t from = 0;
  for (std::int64_t i = 1; i <= segments; ++i) {
    const auto to = static_cast<std::int64_t>(Integer(Integer(units) * i / segments));
    const motion::State start = ramp.at(static_cast<double>(from) * unit_s);
    const motion::State end = ramp.at(static_cast<double>(to) * unit_s);
    const Integer steps = Integer(to - from) * unit.steps;
    const Integer missing = whole(end.position_mm * counts_per_unit) - phase.counts;
    const Integer wanted = missing > 0 ? Integer(missing / steps) : Integer(0);
    const Integer most = request.ab.increment;
    const auto increment = static_cast<std::uint64_t>(std::min(most, std::max(Integer(before), wanted)));
    const SpinSegment segment{increment, (to - from) * unit.seeds};
    append(stairs.segments, segment.increment, segment.seeds, unit.seeds);
    phase = phase_after(request.ab, segment.increment, segment.seeds * request.ticks_per_seed, std::move(phase));
    const double now = to_double(Rational(Integer(increment))) / top * speed;
    stairs.speed_error =
        std::max({stairs.speed_error, std::abs(now - start.velocity_mm_s), std::abs(now - end.velocity_mm_s)});
    before = increment;
    from = to;
  }
  return stairs;
}

Result<AxisSpin> make_spin_up(const SpinRequest& request, const Staircase& stairs, std::int64_t rest_seeds) {
  const AbPlan& ab = request.ab;
  const Unit unit = unit_of(request);
  const Integer edge = counts_per_edge(ab);
  const Integer top = ab.increment;
  std::vector<SpinSegment> ramp;
  append(ramp, 0, rest_seeds, 1);
  const auto rest_segments = static_cast<std::ptrdiff_t>(ramp.size());
  ramp.insert(ramp.end(), stairs.segments.begin(), stairs.segments.end());
  const SpinPhase at_top = phase_after(ab, ramp, request.ticks_per_seed, {});
  // One unit at a time at most `unit.steps * (top + 1)` counts; the one that fills up takes less than one.
  const Integer least = (at_top.counts + edge - 1) / edge;
  const StartEdges start = start_edges(request, stairs, least);
  const Integer target = start.edges * edge;
  const Rational per_unit =
      Rational(Integer(unit.steps)) * (Rational(top) + Rational(Integer(ab.fraction_num), Integer(ab.fraction_den)));
  Integer cruise = floor_of(Rational(Rational(Integer(target - at_top.counts)) / per_unit));
  const auto missing = [&](const Integer& units) {  // with the unit that fills up at increment 0
    const std::int64_t ticks = static_cast<std::int64_t>(Integer((units + 1) * unit.seeds)) * request.ticks_per_seed;
    return Integer(target - phase_after(ab, 0, ticks, at_top).counts - units * unit.steps * top);
  };
  if (cruise > std::numeric_limits<std::int64_t>::max() / (unit.seeds * request.ticks_per_seed) - 2) {
    return Error{ErrorCode::out_of_range, "the spin-up lasts longer than can be counted"};
  }
  while (cruise > 0 && missing(cruise) < 0) {
    --cruise;
  }
  const auto step_up = [&] { return Integer((std::max(Integer(0), missing(cruise)) + unit.steps - 1) / unit.steps); };
  Integer fill_in = step_up();
  if (fill_in > top) {  // by less than a count: a whole unit more fits
    ++cruise;
    fill_in = step_up();
  }
  std::vector<SpinSegment> stair(ramp.begin() + rest_segments, ramp.end());
  insert_step(stair, {static_cast<std::uint64_t>(fill_in), unit.seeds});
  AxisSpin spin;
  spin.up.segments.assign(ramp.begin(), ramp.begin() + rest_segments);
  spin.up.segments.insert(spin.up.segments.end(), stair.begin(), stair.end());
  append(spin.up.segments, ab.increment, static_cast<std::int64_t>(cruise) * unit.seeds, unit.seeds);
  fill(request, stairs, {}, spin.up);
  spin.start_deg = start.start_deg;
  spin.start_error_deg = request.start_deg ? Rational(spin.up.travel - start.start_deg) : Rational(0);
  return spin;
}

SpinPlan make_spin_down(const SpinRequest& request, const Staircase& stairs, const SpinPlan& up) {
  const AbPlan& ab = request.ab;
  const Unit unit = unit_of(request);
  const Integer top = ab.increment;
  SpinPhase marked = phase_after(ab, up.segments, request.ticks_per_seed, {});
  marked = phase_after(ab, ab.increment, request.marking_ticks, std::move(marked));
  const std::vector<SpinSegment> falling(stairs.segments.rbegin(), stairs.segments.rend());
  const Integer target = rest_counts(request, up, phase_after(ab, falling, request.ticks_per_seed, marked).counts);
  const Rational per_unit =
      Rational(Integer(unit.steps)) * (Rational(top) + Rational(Integer(ab.fraction_num), Integer(ab.fraction_den)));
  const auto missing = [&](const Integer& units) {  // with the unit that fills up at increment 0
    const std::int64_t ticks = static_cast<std::int64_t>(Integer((units + 1) * unit.seeds)) * request.ticks_per_seed;
    SpinPhase cruised = phase_after(ab, 0, ticks, marked);
    cruised.counts += units * unit.steps * top;
    return Integer(target - phase_after(ab, falling, request.ticks_per_seed, std::move(cruised)).counts);
  };
  Integer cruise = floor_of(Rational(std::max(Integer(0), missing(0))) / per_unit);
  while (cruise > 0 && missing(cruise) < 0) {
    --cruise;
  }
  const auto step_down = [&] { return Integer((std::max(Integer(0), missing(cruise)) + unit.steps - 1) / unit.steps); };
  Integer fill_in = step_down();
  if (fill_in > top) {
    ++cruise;
    fill_in = step_down();
  }
  SpinPlan down;
  append(down.segments, ab.increment, static_cast<std::int64_t>(cruise) * unit.seeds, unit.seeds);
  std::vector<SpinSegment> stair = falling;
  const SpinSegment step{static_cast<std::uint64_t>(fill_in), unit.seeds};
  stair.insert(
      std::find_if(stair.begin(), stair.end(), [&](const SpinSegment& one) { return one.increment <= step.increment; }),
      step);
  down.segments.insert(down.segments.end(), stair.begin(), stair.end());
  fill(request, stairs, std::move(marked), down);
  return down;
}

}  // namespace gravure::sync_plan
