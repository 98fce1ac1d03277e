#pragma once

#include <array>
#include <cstdint>

#include "gravure/fpga/ab_generator.hpp"
#include "gravure/fpga/direction_delay.hpp"
#include "gravure/fpga/fault_latch.hpp"
#include "gravure/fpga/frame_parser.hpp"
#include "gravure/fpga/increment_schedule.hpp"
#include "gravure/fpga/index_reference.hpp"
#include "gravure/fpga/line_fifo.hpp"
#include "gravure/fpga/line_progress.hpp"
#include "gravure/fpga/line_sequencer.hpp"
#include "gravure/fpga/line_start.hpp"
#include "gravure/fpga/register_map.hpp"
#include "gravure/fpga/register_read.hpp"
#include "gravure/fpga/scanner_clock.hpp"
#include "gravure/fpga/settings.hpp"
#include "gravure/fpga/slot_divider.hpp"
#include "gravure/fpga/slot_gate.hpp"
#include "gravure/fpga/watchdog.hpp"

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/synchro.v, the board's whole logic, made of the models of its blocks: one step() is one
/// rising edge of the FPGA clock. The first step and every second after it are edges of the seed clock too; inputs are
/// looked at then only, and only the pins of the axes move in between. docs/registers.md has the register map.
class Synchro {
 public:
  static constexpr std::size_t kAxes = 2;
  static constexpr AbGenerator::Widths kAxisWidths{.bits = 32, .prescaler_bits = 32, .fraction_bits = 34};
  /// Axis 1 has no fraction (FRACTION_1 = 0): with two of them the logic does not fit on an HX8K.
  static constexpr AbGenerator::Widths kAxis1Widths{
      .bits = 32, .prescaler_bits = 32, .fraction_bits = 34, .fraction = false};

  struct Inputs {
    bool rst = false;
    bool write = false;
    bool in_valid = false;
    bool start = false;
    bool index = false;
    bool interlock = false;
    std::uint8_t address = 0;
    std::uint8_t in_data = 0;
    std::uint32_t write_data = 0;
    friend bool operator==(const Inputs&, const Inputs&) = default;
  };
  struct Outputs {
    bool a = false;
    bool b = false;
    bool a_1 = false;
    bool b_1 = false;
    bool gate = false;
    bool scan = false;
    std::uint8_t fault = 0;
    std::uint32_t read_data = 0;
  };

  explicit Synchro(int fifo_bits, int schedule_bits = 8);
  Outputs step(const Inputs& in) noexcept;
  /// As the register of that name has it.
  std::uint32_t fifo_level() const noexcept { return now_.bits.level; }
  /// As the registers executed_lines and closed_slot have it.
  const LineProgress::Outputs& line_progress() const noexcept { return now_.progress; }

 private:
  friend class SynchroEvents;

  /// What every block showed after the last clock: all that flows between blocks comes from flip-flops.
  struct Wires {
    Settings::Outputs settings;
    std::array<IncrementSchedule::Outputs, kAxes> schedules;
    std::array<AbGenerator::Outputs, kAxes> axes;
    FrameParser::Outputs parser;
    LineFifo::Outputs bits;
    LineQueue::Outputs queue;
    LineStart::Outputs start;
    SlotDivider::Outputs slots;
    LineSequencer::Outputs line;
    IndexReference::Outputs reference;
    DirectionDelay::Outputs delayed;
    SlotGate::Outputs gate;
    LineProgress::Outputs progress;
    ScannerClock::Outputs scanner;
    Watchdog::Outputs host;
    FaultLatch::Outputs faults;
    RegisterRead::Outputs read;
    bool schedules_run = false;
    bool queue_commit = false;
    bool line_missing = false;
    bool was_missing = false;
    bool stream_error = false;
    friend bool operator==(const Wires&, const Wires&) = default;
  };

  AbGenerator::Inputs axis_inputs(std::size_t axis, bool rst) const noexcept;
  void step_seed(const Inputs& in) noexcept;
  void step_axes(const Inputs& in, const Wires& was) noexcept;
  void step_stream(const Inputs& in, const Wires& was) noexcept;
  void step_lines(const Inputs& in, const Wires& was) noexcept;
  void step_gate(const Inputs& in, const Wires& was) noexcept;
  void step_faults(const Inputs& in, const Wires& was) noexcept;
  std::uint16_t status(const Wires& was) const noexcept;

  int fifo_bits_;
  bool seed_edge_ = true;
  Wires now_;
  Settings settings_;
  std::array<IncrementSchedule, kAxes> schedules_;
  std::array<AbGenerator, kAxes> axes_;
  FrameParser parser_;
  LineFifo bits_;
  LineQueue queue_;
  LineStart start_;
  SlotDivider slots_;
  LineSequencer line_;
  IndexReference reference_;
  DirectionDelay delay_;
  SlotGate gate_;
  LineProgress progress_;
  ScannerClock scanner_;
  Watchdog host_;
  FaultLatch faults_;
  RegisterRead read_;
};

}  // namespace gravure::fpga
