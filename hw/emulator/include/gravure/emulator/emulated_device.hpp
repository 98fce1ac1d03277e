#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/line_device.hpp"
#include "gravure/emulator/schedule.hpp"
#include "gravure/fpga/ab_registers.hpp"
#include "gravure/fpga/pulse_gate.hpp"
#include "gravure/fpga/register_map.hpp"

namespace gravure::emulator {

/// Two lines must fit into the largest line FIFO of a board: one that runs and one that is on its way.
inline constexpr std::int64_t kMaxWindowSlots =
    (std::int64_t{8} << static_cast<unsigned>(fpga::kFifoBitsRange.high)) / 2;

/// A board without the board: the bit-exact FPGA model behind LineDevice. It refuses what a board would refuse, by the
/// register map (docs/registers.md): every width and range is taken from there. Where boards may differ (counter_bits,
/// clock_multiplier, fifo_bits) it is the board that the setup asks for, within the range of that register.
///
/// The machine never waits: every send() takes exactly one line time, in which either the frame's line runs or, where
/// the frame is refused or a fault stands, a dark one. So tick and axis go on through a fault as they do on a machine.
/// A refused frame latches the fault; it stands, and every line stays dark, until acknowledge(). The next good frame is
/// then the one of the line whose time has come, not the one that was refused.
///
/// Not safe for several threads at once. The observer, if any, must outlive the device; on_line() is called inside
/// send(), for dark lines too, and what `fired` refers to is valid only during the call.
class EmulatedDevice final : public LineDevice {
 public:
  explicit EmulatedDevice(PinObserver* observer = nullptr) : observer_(observer) {}

  /// Loads the registers for a run and puts the machine at `first_line` of `first_revolution`. device, naming field,
  /// value and allowed range, where a register would not take its value, where the job would outlast 2^63 - 1 ticks, or
  /// while a fault stands; the machine then is as before.
  Result<void> configure(const DeviceSetup& setup) override;

  /// Runs one line time. device where the frame is refused: in this order sequence (exactly the next line), shape (bits
  /// of the window, unused low bits 0, window inside the line), checksum; or while a fault stands, or before
  /// configure(), or after the last line of the run (neither of these two takes a line time).
  Result<void> send(const LineFrame& frame) override;

  /// A line time in which no frame comes: latches the fault, underrun where the host still speaks, host_silence where
  /// it does not (the emulated watchdog waits for one line time), and runs a dark line. Fails as send() does; here only
  /// before configure() and after the last line of the run.
  Result<void> pass_line(DeviceFault fault, std::string detail);

  /// `lines_executed` counts the lines of good frames, `tick` every line time since tick 0 of the job, dark ones too.
  DeviceStatus status() const override;

  DeviceFault fault() const noexcept { return fault_; }
  /// Clears the fault; the next line may fire.
  void acknowledge();
  /// Latches a fault from outside the link: interlock, host_silence or underrun (`none` is ignored).
  void raise_fault(DeviceFault fault, std::string detail);

 private:
  static Result<void> check_schedules(const DeviceSetup& setup);
  AxisState turned(const AxisState& state) const;  ///< the way axis 0 of the run goes
  AxisState axis_at(std::int64_t tick) const;
  Error refuse(DeviceFault fault, std::string detail);
  /// What is wrong with `frame`, or an empty text.
  std::string sequence_violation(const LineFrame& frame) const;
  std::string shape_violation(const LineFrame& frame) const;
  void run_line(const LineFrame& frame, bool dark);
  Result<void> check_running(const std::string& what);
  std::string place() const;  ///< "revolution 1, line 2"

  PinObserver* observer_;
  bool configured_ = false;
  DeviceSetup setup_;
  fpga::AbRegisters ab_;
  fpga::AbRegisters carriage_;
  ScheduleEnd ab_start_;
  ScheduleEnd carriage_start_;
  std::int64_t ticks_per_line_ = 0;
  std::int64_t run_tick_ = 0;  ///< of the job, at which the run's first line begins
  std::vector<std::byte> fired_;

  std::int64_t revolution_ = 0;  ///< of the next line
  std::int64_t line_ = 0;
  std::int64_t ordinal_ = 0;
  std::int64_t lines_executed_ = 0;
  DeviceFault fault_ = DeviceFault::none;
  std::string detail_;
};

}  // namespace gravure::emulator
