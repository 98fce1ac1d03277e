#pragma once

#include <cstdint>

#include "gravure/core/line_device.hpp"
#include "gravure/core/plan.hpp"

namespace gravure {

/// Where a channel's counter stands: counts put out since it was at rest, and what its fraction has gathered.
struct SpinPhase {
  Integer counts = 0;
  std::uint64_t accumulator = 0;  ///< of the fraction; less than its denominator
};

/// `from` after `ticks` FPGA ticks in which the counter adds `increment` on every prescaler-th.
SpinPhase phase_after(const AbPlan& ab, std::uint64_t increment, std::int64_t ticks, SpinPhase from);

/// `from` after all segments; a seed clock has `ticks_per_seed` ticks.
SpinPhase phase_after(const AbPlan& ab, const std::vector<SpinSegment>& segments, std::int64_t ticks_per_seed,
                      SpinPhase from);

/// What a counter has beyond whole A-B edges at tick 0 of the job: 0 in all where the axis turns already. Then edges
/// since tick 0 are floor((counts + ...) / 2^(n-2)) of the registers alone, later as of this.
struct SpinStart {
  std::uint64_t counts = 0;       ///< of the edge that is under way
  std::uint64_t accumulator = 0;  ///< of the fraction
};
SpinStart spin_start(const AbPlan& ab, const std::optional<AxisSpin>& spin);

/// Flat mode: by how many edges the stage leads when the lines of a way back begin, because a whole A-B period is too
/// coarse for where the pass before has ended: both spin-ups and the pass, less what lies between the places of rest. 0
/// without ramps.
Rational way_back_lead(const Plan& plan);

/// The counts of a device's axis, with sign.
Integer counts_of(const AxisState& state);

/// Edges put out in the whole of a spin-up.
Integer spin_edges(const AbPlan& ab, const SpinPlan& up);

}  // namespace gravure
