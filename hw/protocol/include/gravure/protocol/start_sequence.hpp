#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/line_device.hpp"
#include "gravure/fpga/register_map.hpp"

namespace gravure::protocol {

/// One 32-bit word into a register of docs/registers.md.
struct RegisterWrite {
  std::uint8_t address = 0;
  std::uint32_t value = 0;
  friend bool operator==(const RegisterWrite&, const RegisterWrite&) = default;
};

/// Changes nothing: said while there is nothing to send, so that the board's watchdog does not take the host for dead.
inline constexpr RegisterWrite kKeepAlive{fpga::kLowLevelRegister.address, 0};

/// Bits of the control register.
inline constexpr std::uint32_t kControlRun = 1;
inline constexpr std::uint32_t kControlAxis0 = 2;
inline constexpr std::uint32_t kControlWatchdog = 4;
inline constexpr std::uint32_t kControlAxis1 = 8;
inline constexpr std::uint32_t kControlTimed = 16;
inline constexpr std::uint32_t kControlBackward = 32;
inline constexpr std::uint32_t kControlAxis0Backward = 128;

/// Bits of the command register.
inline constexpr std::uint32_t kCommandAcknowledge = 1;
inline constexpr std::uint32_t kCommandLoad0 = 2;
inline constexpr std::uint32_t kCommandPosition = 8;
inline constexpr std::uint32_t kCommandLoad1 = 16;
inline constexpr std::uint32_t kCommandGo = 64;
inline constexpr std::uint32_t kCommandAppend0 = 128;
inline constexpr std::uint32_t kCommandAppend1 = 256;
inline constexpr std::uint32_t kCommandStopSchedules = 512;

/// Bits of the status register that say why a start was refused.
inline constexpr std::uint32_t kStatusLoad0Refused = 1U << 5U;
inline constexpr std::uint32_t kStatusLoad1Refused = 1U << 7U;
inline constexpr std::uint32_t kStatusScheduleBusy = 3U << 8U;
inline constexpr std::uint32_t kStatusScheduleOverflow = 1U << 10U;
inline constexpr std::uint32_t kStatusSettingRefused = 1U << 11U;

/// Segments a schedule of the board holds.
inline constexpr std::size_t kMostSegments = 256;
/// Seed clocks from go until an axis or a line may do anything: more than a load of the A-B registers takes.
inline constexpr std::uint64_t kStartLead = 16;

/// Of a start, beyond a DeviceSetup.
struct LineTiming {
  std::int64_t slots_per_microvector = 1;
  /// By how many FPGA ticks backward lines (those with an odd number over the job) come later; less than a slot,
  /// negative: earlier. Whole slots are in the frames already.
  std::int64_t backward_later_ticks = 0;
  /// Lines whose time passes, dark, before the first one that is sent: where a job goes on at line l of a revolution
  /// the axis comes to the angle of that line, from the same reference.
  std::uint64_t lines_before = 0;
  std::uint64_t lead_seeds = kStartLead;  ///< at least kStartLead
  std::uint64_t silence_seeds = 0;        ///< silence_limit; 0: the watchdog stays off
  /// The axes stop behind the last line even where the setup has no ramp down: a stage that is to turn round.
  bool stop_at_end = false;
  /// Left in schedule_increment, which nothing reads after the last segment: a host that comes back knows by it that
  /// the lines the board has counted are its own.
  std::uint32_t mark = 0;
};

/// What a host writes, in this order. Between `prepare` and `start` it streams frames.
struct StartSequence {
  /// Gate closed, faults acknowledged, the settings of axes and lines; the A-B registers are loaded where nothing
  /// moves, so that the status register says whether the board takes everything.
  std::vector<RegisterWrite> settings;
  /// The axes enabled but at rest, the schedules, the position.
  std::vector<RegisterWrite> prepare;
  /// Lines run from the last of these on: it loads both axes and says go.
  std::vector<RegisterWrite> start;
  /// The axes come to rest by themselves behind the last line. Not where they are not to, nor where that takes more
  /// segments than the board holds.
  bool ends_at_rest = false;
  std::uint64_t first_tick = 0;  ///< seed clocks from go to the first line that is sent
};

/// device where a value does not fit its register, a schedule not into its list, or backward lines should come later by
/// no whole seed clocks; out_of_range where the first line would come later than the board counts.
Result<StartSequence> start_sequence(const DeviceSetup& setup, const LineTiming& timing);

/// First slot of a line as its frame has it: a backward line that should come earlier by part of a slot begins a slot
/// earlier, and the board's delay makes up for the rest. device where that would be before slot 0.
Result<std::int64_t> framed_first_slot(std::int64_t first_slot, bool backward, const LineTiming& timing);

/// device where backward lines should come later by no whole seed clocks of `clock_multiplier` FPGA ticks: the board
/// has no finer delay.
Result<void> check_backward_delay(std::int64_t later_ticks, std::int64_t clock_multiplier);

/// Brings both axes to rest: the gate closed, then the segments of either axis from now on. An axis without any stops
/// at once.
std::vector<RegisterWrite> stop_sequence(std::span<const ScheduleSegment> axis,
                                         std::span<const ScheduleSegment> carriage);

}  // namespace gravure::protocol
