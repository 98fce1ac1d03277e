#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/device_fault.hpp"
#include "gravure/core/error.hpp"

namespace gravure {

/// What a board takes at most (docs/registers.md: seeds_per_slot, clock_multiplier).
inline constexpr std::int64_t kMostSeedsPerSlot = 65'535;
inline constexpr std::int64_t kMostClockMultiplier = 16;

/// A segment of a channel's schedule: its counter's increment for so many seed clocks.
struct ScheduleSegment {
  std::uint64_t increment = 0;
  std::uint64_t seeds = 0;
};

/// The second A-B channel, which drives the carriage of helical jobs; its counter is as wide as the first. It stands
/// still with an increment of 0. Boards have a fraction for the first channel alone: here only 0/1 is taken.
struct CarriageSetup {
  std::uint64_t prescaler = 1;
  std::uint64_t increment = 0;
  std::uint64_t fraction_num = 0;
  std::uint64_t fraction_den = 1;
  std::vector<ScheduleSegment> spin_up = {};    ///< as that of the first channel
  std::vector<ScheduleSegment> spin_down = {};  ///< likewise
};

/// What is loaded into the board's registers before a run (board_runs.hpp), which is a stretch of the job that the
/// board puts out without a break; all integers, all in FPGA ticks or slots.
struct DeviceSetup {
  int counter_bits = 32;
  std::uint64_t prescaler = 1;
  std::uint64_t increment = 0;
  std::uint64_t fraction_num = 0;
  std::uint64_t fraction_den = 1;
  CarriageSetup carriage = {};
  /// Axis 0 steps backwards: from the load on, the edges of A and B come in reverse order, from whatever the pins are;
  /// to turn makes no edge. The load keeps the counter, which counts up all the same; only a reset clears it.
  bool backward = false;
  /// Run from rest before the first line of the run, which is at its end: as `schedule_increment` and
  /// `schedule_seeds` take it, with `go` at its begin and its seed clocks in `first_tick`. Empty: edges are counted
  /// from 0 with that line.
  std::vector<ScheduleSegment> spin_up = {};
  /// Run after the last line, to rest. Empty: the axis is stopped there by other means.
  std::vector<ScheduleSegment> spin_down = {};
  std::int64_t clock_multiplier = 1;  ///< j: FPGA ticks per seed pulse
  std::int64_t ticks_per_slot = 1;    ///< a whole multiple of j
  std::int64_t slots_per_line = 1;    ///< np
  std::int64_t window_slots = 0;      ///< pixels per line; the gate stays dark outside the window
  std::int64_t lines_per_revolution = 1;
  std::int64_t begin_revolution = 0;  ///< of the job, the first of the run: counters begin with its line 0
  std::int64_t end_revolution = 1;    ///< after the last of the run
  std::int64_t first_revolution = 0;  ///< start here, with the axis where the run has it at that tick
  std::int64_t first_line = 0;        ///< of first_revolution
};

/// One line on the wire: the bits of its marking window.
struct LineFrame {
  std::int64_t revolution = 0;
  std::int64_t line = 0;
  std::int64_t first_slot = 0;      ///< of the window
  std::span<const std::byte> bits;  ///< (window_slots + 7) / 8 bytes, MSB first, 1 fires
  std::uint32_t crc32c = 0;         ///< frame_crc32c() of the frame
};

/// CRC-32C over revolution, line, first slot (64-bit little endian each) and the bits.
std::uint32_t frame_crc32c(const LineFrame& frame) noexcept;

/// Where an axis stands by the A-B generator's own count, from a place that is said with it. An axis that runs backward
/// goes below 0: edges and counts are those of the counter, with the sign of the axis.
struct AxisState {
  std::int64_t edges = 0;        ///< A-B edges put out: forwards less backwards
  std::int64_t counts_high = 0;  ///< the counter unwrapped, two's complement of 128 bits: 2^(n-2) are an edge
  std::uint64_t counts_low = 0;

  friend bool operator==(const AxisState&, const AxisState&) = default;
};

/// A line as the board's pins showed it.
struct ExecutedLine {
  std::int64_t start_tick = 0;       ///< of its slot 0
  std::int64_t ordinal = 0;          ///< lines since tick 0 of the job
  std::int64_t first_slot = 0;       ///< of `fired`
  std::span<const std::byte> fired;  ///< window_slots bits, MSB first: what the gate let through
  AxisState axis_at_start;           ///< from where it stood when the first line of the run began
  AxisState carriage_at_start = {};  ///< likewise
};

/// Sees the pins of an emulated board (real boards have none to show).
class PinObserver {
 public:
  virtual ~PinObserver() = default;
  virtual void on_line(const ExecutedLine& line) = 0;
};

struct DeviceStatus {
  std::int64_t lines_executed = 0;
  std::int64_t tick = 0;                  ///< ticks since tick 0 of the job
  AxisState axis;                         ///< at that tick, from where it stood when the run's first line began
  AxisState carriage = {};                ///< likewise
  AxisState axis_spun_up = {};            ///< there, from rest: what the schedule before the run's first line put out
  AxisState carriage_spun_up = {};        ///< likewise
  std::optional<AxisState> axis_at_rest;  ///< after the run's last line and spin-down, from rest before it
  std::optional<AxisState> carriage_at_rest = {};  ///< likewise
  DeviceFault fault = DeviceFault::none;           ///< sticky; the gate is closed while it stands
  std::string detail;                              ///< what was refused and why
};

/// A machine that takes one line in each line time: what verify, unroll and emulate run programs on. Refuses what the
/// board would refuse, with ErrorCode::device. Boards on a wire are a DeviceLink (device_link.hpp).
class LineDevice {
 public:
  virtual ~LineDevice() = default;
  virtual Result<void> configure(const DeviceSetup& setup) = 0;
  virtual Result<void> send(const LineFrame& frame) = 0;
  virtual DeviceStatus status() const = 0;
};

}  // namespace gravure
