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

Integer counts_of(const AxisState& state) {
  return Integer(state.counts_high) * (Integer(1) << 64U) + Integer(state.counts_low);
}

Integer spin_edges(const AbPlan& ab, const SpinPlan& up) {
  return up.counts / counts_per_edge(ab);
}

}  // namespace gravure
