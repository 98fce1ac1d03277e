#pragma once

#include <cstdint>

#include "gravure/fpga/ab_generator.hpp"
#include "gravure/fpga/fault_latch.hpp"
#include "gravure/fpga/frame_parser.hpp"
#include "gravure/fpga/line_fifo.hpp"
#include "gravure/fpga/line_sequencer.hpp"
#include "gravure/fpga/register_map.hpp"
#include "gravure/fpga/scanner_clock.hpp"
#include "gravure/fpga/slot_divider.hpp"
#include "gravure/fpga/slot_gate.hpp"
#include "gravure/fpga/watchdog.hpp"

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/synchro.v, the board's whole logic, made of the models of its blocks: one step() is one
/// rising edge of the FPGA clock. The first step and every second after it are edges of the seed clock too; inputs are
/// looked at then only, and only the pins of the axis move in between. docs/registers.md has the register map.
class Synchro {
 public:
  static constexpr AbGenerator::Widths kAxisWidths{.bits = 32, .prescaler_bits = 32, .fraction_bits = 34};
  /// Seed clocks from the first tick of a slot to `gate`: divider, sequencer, gate.
  static constexpr int kSlotToGate = 1 + LineSequencer::kLatency + SlotGate::kLatency;

  struct Inputs {
    bool rst = false;
    bool write = false;
    bool in_valid = false;
    bool start = false;
    bool interlock = false;
    std::uint8_t address = 0;
    std::uint8_t in_data = 0;
    std::uint32_t write_data = 0;
  };
  struct Outputs {
    bool a = false;
    bool b = false;
    bool gate = false;
    bool scan = false;
    std::uint8_t fault = 0;
    std::uint32_t read_data = 0;
  };

  explicit Synchro(int fifo_bits);
  Outputs step(const Inputs& in) noexcept;

 private:
  struct Registers {
    std::uint32_t control = kControlRegister.reset;
    std::uint32_t command = 0;
    std::uint32_t increment = kIncrementRegister.reset;
    std::uint32_t prescaler = kPrescalerRegister.reset;
    std::uint64_t fraction_num = kFractionNumRegister.reset;
    std::uint64_t fraction_den = kFractionDenRegister.reset;
    std::uint32_t num_low = 0;
    std::uint32_t den_low = 0;
    std::uint16_t ticks_per_slot = kTicksPerSlotRegister.reset;
    std::uint16_t slots_per_line = kSlotsPerLineRegister.reset;
    std::uint16_t window_slots = kWindowSlotsRegister.reset;
    std::uint16_t slots_per_microvector = kSlotsPerMicrovectorRegister.reset;
    std::uint32_t lines_per_revolution = kLinesPerRevolutionRegister.reset;
    std::uint32_t position_revolution = kPositionRevolutionRegister.reset;
    std::uint32_t position_line = kPositionLineRegister.reset;
    std::uint32_t silence_limit = kSilenceLimitRegister.reset;
  };
  /// What every block showed after the last clock: all that flows between blocks comes from flip-flops.
  struct Wires {
    AbGenerator::Outputs axis;
    FrameParser::Outputs parser;
    LineFifo::Outputs bits;
    LineQueue::Outputs queue;
    SlotDivider::Outputs slots;
    LineSequencer::Outputs line;
    SlotGate::Outputs gate;
    ScannerClock::Outputs scanner;
    Watchdog::Outputs host;
    FaultLatch::Outputs faults;
    bool queue_commit = false;
    bool started = false;
    bool was_missing = false;
    std::uint32_t read_data = 0;
  };

  static void write(Registers& registers, std::uint8_t address, std::uint32_t data) noexcept;
  std::uint32_t read(std::uint8_t address) const noexcept;
  void step_seed(const Inputs& in) noexcept;
  void step_stream(const Inputs& in, const Wires& was) noexcept;
  void step_lines(const Inputs& in, const Wires& was) noexcept;
  void step_faults(const Inputs& in, const Wires& was, bool missing) noexcept;
  bool run() const noexcept { return (registers_.control & 1U) != 0; }
  bool acknowledge() const noexcept { return (registers_.command & 1U) != 0; }

  int fifo_bits_;
  bool seed_edge_ = true;
  Registers registers_;
  Wires now_;
  AbGenerator axis_;
  FrameParser parser_;
  LineFifo bits_;
  LineQueue queue_;
  SlotDivider slots_;
  LineSequencer line_;
  SlotGate gate_;
  ScannerClock scanner_;
  Watchdog host_;
  FaultLatch faults_;
};

}  // namespace gravure::fpga
