#pragma once

#include <cstdint>
#include <functional>

#include "gravure/core/device_link.hpp"
#include "gravure/core/error.hpp"
#include "gravure/fpga/synchro.hpp"

namespace gravure::emulator {

/// A host on the wires of the board: turns a setup and frames into what the board's inputs show, clock by clock. Lines
/// start at a programmed tick; each frame goes out while the line before its own runs.
class BoardHost {
 public:
  /// Holds the inputs for some FPGA clocks.
  using Wires = std::function<Result<void>(const fpga::Synchro::Inputs& inputs, std::uint64_t clocks)>;

  BoardHost(int fifo_bits, Wires wires) : fifo_bits_(fifo_bits), wires_(std::move(wires)) {}

  /// The A-B registers of both channels alone, loaded, and the axes enabled: from now on they run. device where a value
  /// does not fit its register.
  Result<void> start_axis(const DeviceSetup& setup);
  /// Everything a program needs; the first line is that of the setup. The axis starts at 0 with it: boards do not
  /// preset their counters. device as before, and where a line does not fit twice into the FIFO or its frame does not
  /// come in a line time.
  Result<void> start_lines(const DeviceSetup& setup, std::int64_t slots_per_microvector);
  /// The next line. Frames are signed by the caller.
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
  Result<void> byte(std::uint8_t data);
  Result<void> word(std::uint64_t data, int bytes);

  int fifo_bits_;
  Wires wires_;
  std::uint64_t now_ = 0;         ///< seed clocks since go
  std::uint64_t first_line_ = 0;  ///< when it starts, nearly: the latency of the start comes on top
  std::uint64_t line_seeds_ = 0;
  std::uint64_t sent_ = 0;
};

}  // namespace gravure::emulator
