#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/line_device.hpp"
#include "gravure/fpga/ab_edges.hpp"

namespace gravure::emulator {

/// What the list of an increment_schedule holds.
inline constexpr std::size_t kScheduleSegments = 256;

/// A channel's counter in closed form, from one change of its inputs to the next.
class AxisWalk {
 public:
  AxisWalk() = default;
  /// From a counter of `counts`, its fraction at `accumulator`. check(registers) must be none.
  explicit AxisWalk(const fpga::AbRegisters& registers, fpga::Uint128 counts = 0,
                    std::uint64_t accumulator = 0) noexcept
      : registers_(registers), counts_(counts), accumulator_(accumulator) {}
  /// Prescaler and fraction begin anew; the counter goes on from where it is. check(registers) must be none.
  void load(const fpga::AbRegisters& registers) noexcept;
  /// From the next step on; at most max_increment().
  void set_increment(std::uint64_t increment) noexcept { registers_.increment = increment; }
  void run(std::uint64_t ticks) noexcept;

  const fpga::AbRegisters& registers() const noexcept { return registers_; }
  fpga::Uint128 counts() const noexcept { return counts_; }
  std::uint64_t accumulator() const noexcept { return accumulator_; }
  /// All edges since the counter was 0.
  AxisState state() const noexcept;

 private:
  fpga::AbRegisters registers_;
  fpga::Uint128 counts_ = 0;
  std::uint64_t accumulator_ = 0;  ///< of the fraction
  std::uint64_t since_step_ = 0;   ///< ticks since the prescaler's last step
};

/// Where a channel's schedule leaves its counter.
struct ScheduleEnd {
  fpga::Uint128 counts = 0;       ///< put out from rest
  std::uint64_t accumulator = 0;  ///< of the fraction
};

/// device where a segment does not fit its registers, is no whole steps of the prescaler, or the schedule does not fit
/// the board's list. `field` names it.
Result<void> check_schedule(const std::string& field, const std::vector<ScheduleSegment>& segments,
                            const fpga::AbRegisters& registers, std::int64_t ticks_per_seed);

/// device where a spin-up lasts longer than `first_tick` counts.
Result<void> check_lead(const std::string& field, const std::vector<ScheduleSegment>& segments);

/// Runs a schedule that check_schedule() passes, from where the counter stands.
ScheduleEnd run_schedule(const std::vector<ScheduleSegment>& segments, const fpga::AbRegisters& registers,
                         std::int64_t ticks_per_seed, const ScheduleEnd& from = {}) noexcept;

/// `ticks` ticks of marking from there.
ScheduleEnd mark(const ScheduleEnd& from, const fpga::AbRegisters& registers, std::int64_t ticks) noexcept;

/// The counter's state, from rest.
AxisState state_of(const ScheduleEnd& end, const fpga::AbRegisters& registers) noexcept;

/// An axis that runs the other way.
AxisState mirrored(const AxisState& state) noexcept;

/// The channel `tick` ticks after that, its edges counted from there.
AxisState axis_after(const ScheduleEnd& end, const fpga::AbRegisters& registers, std::int64_t tick) noexcept;

}  // namespace gravure::emulator
