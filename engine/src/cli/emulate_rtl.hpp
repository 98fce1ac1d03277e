#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emulate.hpp"
#include "gravure/emulator/board_host.hpp"
#include "gravure/emulator/rtl_board.hpp"
#include "gravure/fpga/synchro_events.hpp"

namespace gravure::cli {

/// The board twice: its Verilog clock by clock and its model from event to event, with the same inputs; every pin is
/// compared on every clock.
class TwoBoards {
 public:
  static Result<TwoBoards> load();

  /// device at the first clock on which a pin differs, saying which.
  Result<void> hold(const fpga::Synchro::Inputs& inputs, std::uint64_t clocks);

  std::uint64_t clocks() const { return events_.clock(); }
  std::uint64_t edges() const { return edges_; }
  std::uint64_t gate_clocks() const { return gate_clocks_; }
  std::uint8_t fault() const { return pins_.fault; }

 private:
  explicit TwoBoards(emulator::RtlBoard rtl) : rtl_(std::move(rtl)), events_(emulator::kRtlFifoBits) {}

  emulator::RtlBoard rtl_;
  fpga::SynchroEvents events_;
  fpga::SynchroEvents::Event pins_;
  std::vector<fpga::SynchroEvents::Event> expected_;
  std::uint64_t edges_ = 0;
  std::uint64_t gate_clocks_ = 0;
};

/// The counter of --clocks on both boards; edges are also held against the closed form.
Result<Json> counter_on_rtl(const EmulateOptions& options);

}  // namespace gravure::cli
