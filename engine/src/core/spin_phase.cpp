#include "gravure/core/spin_phase.hpp"

#include <utility>

namespace gravure {
namespace {

Integer counts_per_edge(const AbPlan& ab) {
  return Integer(1) << static_cast<unsigned>(ab.counter_bits - 2);
}

}  // namespace

SpinPhase phase_after(const AbPlan& ab, std::uint64_t increment, std::int64_t ticks, SpinPhase from) {
  const Integer steps = Integer(ticks) / Integer(ab.prescaler);
  const Integer gathered = steps * Integer(ab.fraction_num) + Integer(from.accumulator);
  from.counts += steps * Integer(increment) + gathered / Integer(ab.fraction_den);
  from.accumulator = static_cast<std::uint64_t>(Integer(gathered % Integer(ab.fraction_den)));
  return from;
}

SpinPhase phase_after(const AbPlan& ab, const std::vector<SpinSegment>& segments, std::int64_t ticks_per_seed,
                      SpinPhase from) {
  for (const SpinSegment& segment : segments) {
    from = phase_after(ab, segment.increment, segment.seeds * ticks_per_seed, std::move(from));
  }
  return from;
}

SpinStart spin_start(const AbPlan& ab, const std::optional<AxisSpin>& spin) {
  if (!spin) {
    return {};
  }
  const Integer steps = Integer(spin->up.ticks) / Integer(ab.prescaler);
  return {static_cast<std::uint64_t>(Integer(spin->up.counts % counts_per_edge(ab))),
          static_cast<std::uint64_t>(Integer(steps * Integer(ab.fraction_num) % Integer(ab.fraction_den)))};
}

Rational way_back_lead(const Plan& plan) {
  if (plan.mode != Mode::flat || !plan.spin) {
    return 0;
  }
  const std::int64_t ticks_per_seed = plan.clock.fpga_hz / plan.clock.seed_hz;
  SpinPhase phase = phase_after(plan.ab, plan.spin->up.segments, ticks_per_seed, {});
  const Integer up = phase.counts / counts_per_edge(plan.ab);
  phase = phase_after(plan.ab, plan.ab.increment, plan.rotary.ticks_per_revolution, std::move(phase));
  const Integer rest = (phase.counts + plan.spin->down.counts) / counts_per_edge(plan.ab);
  return plan.rotary.edges_per_revolution + Rational(Integer(2 * up - rest));
}

Integer counts_of(const AxisState& state) {
  return Integer(state.counts_high) * (Integer(1) << 64U) + Integer(state.counts_low);
}

Integer spin_edges(const AbPlan& ab, const SpinPlan& up) {
  return up.counts / counts_per_edge(ab);
}

}  // namespace gravure
