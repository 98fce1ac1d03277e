#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/line_device.hpp"
#include "gravure/fpga/ab_edges.hpp"

namespace gravure::emulator {

/// Where a channel's schedule leaves its counter at tick 0.
struct ScheduleEnd {
  fpga::Uint128 counts = 0;       ///< put out from rest
  std::uint64_t accumulator = 0;  ///< of the fraction
};

/// device where a segment does not fit its registers, is no whole steps of the prescaler, or the schedule does not fit
/// the board's list or lasts longer than `first_tick` counts. `field` names it.
Result<void> check_schedule(const std::string& field, const std::vector<ScheduleSegment>& segments,
                            const fpga::AbRegisters& registers, std::int64_t ticks_per_seed);

/// Runs a schedule that check_schedule() passes, from a counter of 0.
ScheduleEnd run_schedule(const std::vector<ScheduleSegment>& segments, const fpga::AbRegisters& registers,
                         std::int64_t ticks_per_seed) noexcept;

/// The counter's state at tick 0.
AxisState spun_up(const ScheduleEnd& end, const fpga::AbRegisters& registers) noexcept;

/// The channel `tick` ticks after that, its edges counted from there.
AxisState axis_after(const ScheduleEnd& end, const fpga::AbRegisters& registers, std::int64_t tick) noexcept;

}  // namespace gravure::emulator
