#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "gravure/core/error.hpp"
#include "gravure/core/line_device.hpp"
#include "gravure/fpga/synchro.hpp"

namespace gravure::emulator {

/// device where backward lines should come later by no whole seed clocks of `clock_multiplier` FPGA ticks: the board
/// has no finer delay. `later_ticks` is what a bidirectional offset leaves beside whole slots.
Result<void> check_backward_delay(std::int64_t later_ticks, std::int64_t clock_multiplier);

/// A host on the wires of the board: turns a setup and frames into what the board's inputs show, clock by clock. Lines
/// start at a programmed tick; each frame goes out while the line before its own runs.
class BoardHost {
 public:
  /// Holds the inputs for some FPGA clocks.
  using Wires = std::function<Result<void>(const fpga::Synchro::Inputs& inputs, std::uint64_t clocks)>;

  /// Of the lines, beyond a DeviceSetup.
  struct Lines {
    std::int64_t slots_per_microvector = 1;
    /// By how many FPGA ticks backward lines (those with an odd number over the job) come later; less than a slot,
    /// negative: earlier. Whole slots are in the frames already.
    std::int64_t backward_later_ticks = 0;
  };

  BoardHost(int fifo_bits, Wires wires) : fifo_bits_(fifo_bits), wires_(std::move(wires)) {}

  /// FPGA clocks from the end of start_axis() until the pins show what the counter is at clock 0: the load is taken two
  /// seed clocks after the write of its command began.
  static constexpr std::uint64_t kAxisLatency =
      std::uint64_t{fpga::Settings::kLatency - 1} * fpga::AbGenerator::kClockMultiplier + 1 +
      std::uint64_t{fpga::AbGenerator::load_latency(fpga::Synchro::kAxisWidths)};

  /// The A-B registers of both channels alone, loaded, and the axes enabled: from now on they run. device where a value
  /// does not fit its register.
  Result<void> start_axis(const DeviceSetup& setup);
  /// Everything a program needs; the first line is that of the setup. The axis starts at 0 with it: boards do not
  /// preset their counters. device as before, where a line does not fit twice into the FIFO or its frame does not
  /// come in a line time, or where backward lines should come later by no whole seed clocks.
  Result<void> start_lines(const DeviceSetup& setup, const Lines& lines);
  /// The next line. Frames are signed by the caller. device where a backward line should begin before its slot 0.
  Result<void> send(const LineFrame& frame);
  /// Until the last line that was sent is nearly over: a fault that stands then is one of the lines.
  Result<void> finish();
  /// Until its gate has closed. No line follows, so the board notes an underrun meanwhile.
  Result<void> close();
  /// FPGA clocks.
  Result<void> wait(std::uint64_t clocks) { return wires_({}, clocks); }

 private:
  Result<void> write(const fpga::Register& target, std::uint64_t value);
  Result<void> write_axis(const DeviceSetup& setup);
  Result<void> wait_until(std::uint64_t seed_clock);
  Result<void> write_delay(const DeviceSetup& setup, std::int64_t later_ticks);
  bool is_backward(const LineFrame& frame) const;
  Result<void> put(const LineFrame& frame);
  Result<void> byte(std::uint8_t data);
  Result<void> bytes(std::span<const std::byte> data);

  int fifo_bits_;
  Wires wires_;
  std::uint64_t now_ = 0;         ///< seed clocks since go
  std::uint64_t first_line_ = 0;  ///< when it starts, nearly: the latency of the start comes on top
  std::uint64_t line_seeds_ = 0;
  std::uint64_t sent_ = 0;
  std::int64_t lines_per_revolution_ = 1;
  std::uint64_t control_ = 0;          ///< of the program
  bool backward_one_earlier_ = false;  ///< backward lines begin one slot earlier, and the delay makes up for it
};

}  // namespace gravure::emulator
