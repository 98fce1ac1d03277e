#pragma once

#include <memory>
#include <string>

#include "gravure/core/error.hpp"
#include "gravure/fpga/gravure_fpga.h"

namespace gravure::emulator {

/// What the module with the Verilog board gives; its function is called gravure_rtl_module.
struct RtlModule {
  int abi_version;
  void* (*create)();
  void (*step)(void* board, const gravure_fpga_board_inputs* inputs, gravure_fpga_board_outputs* outputs);
  void (*destroy)(void* board);
};
inline constexpr int kRtlAbiVersion = 1;
using RtlModuleFunction = const RtlModule* (*)();

/// The Verilog of the board (fpga/rtl/synchro.v, a line FIFO of 2^kRtlFifoBits bytes) under Verilator, from a module
/// that is built only where Verilator is and loaded only here.
inline constexpr int kRtlFifoBits = 12;
class RtlBoard {
 public:
  /// io where the module is not there, with what to install; version_mismatch where it is another build's.
  static Result<RtlBoard> load();
  /// One rising edge of the FPGA clock, as gravure_fpga_board_step().
  gravure_fpga_board_outputs step(const gravure_fpga_board_inputs& inputs) {
    gravure_fpga_board_outputs outputs{};
    step_(board_.get(), &inputs, &outputs);
    return outputs;
  }

 private:
  explicit RtlBoard(const RtlModule& module) : step_(module.step), board_(module.create(), module.destroy) {}
  void (*step_)(void*, const gravure_fpga_board_inputs*, gravure_fpga_board_outputs*);
  std::unique_ptr<void, void (*)(void*)> board_;
};

}  // namespace gravure::emulator
