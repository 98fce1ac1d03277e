#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emulate/emulate.hpp"
#include "gravure/emulator/board_host.hpp"
#include "gravure/emulator/rtl_board.hpp"
#include "gravure/fpga/synchro_events.hpp"

namespace gravure::cli {

/// The board twice: its Verilog clock by clock and its model from event to event, with the same inputs; every pin is
/// compared on every clock, and the clocks on which one differs are counted.
class TwoBoards {
 public:
  static Result<TwoBoards> load();

  /// Clocks with a difference after which hold() stops.
  static constexpr std::uint64_t kMostDifferences = 10;

  /// device once kMostDifferences have been seen; cancelled.
  Result<void> hold(const fpga::Synchro::Inputs& inputs, std::uint64_t clocks);

  /// device where a pin differed at all: on how many clocks, and which were the pins of the first.
  Result<void> check() const;

  std::uint64_t clocks() const { return compared_; }
  std::uint64_t edges() const { return edges_; }              ///< of axis 0, put out by the Verilog
  std::uint64_t gate_clocks() const { return gate_clocks_; }  ///< with the gate of the Verilog open
  std::uint8_t fault() const { return shown_.fault; }
  /// Everything counted, for --json.
  Json counts() const;

 private:
  void compare(const gravure_fpga_board_outputs& rtl);

  explicit TwoBoards(emulator::RtlBoard rtl) : rtl_(std::move(rtl)), events_(emulator::kRtlFifoBits) {}

  emulator::RtlBoard rtl_;
  fpga::SynchroEvents events_;
  fpga::SynchroEvents::Event pins_;
  std::vector<fpga::SynchroEvents::Event> expected_;
  gravure_fpga_board_outputs shown_{};  ///< by the Verilog after the latest clock
  std::uint64_t compared_ = 0;
  std::uint64_t edges_ = 0;
  std::uint64_t gate_clocks_ = 0;
  std::uint64_t gate_changes_ = 0;
  std::uint64_t differences_ = 0;
  std::string first_difference_;
};

/// TwoBoards::counts() for the operator.
std::string rtl_text(const Json& counts);

/// The counter of --clocks on both boards; edges are also held against the closed form.
Result<Json> counter_on_rtl(const EmulateOptions& options);

}  // namespace gravure::cli
