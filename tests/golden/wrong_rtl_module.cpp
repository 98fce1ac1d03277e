// A module like gravure_rtl.so for `emulate --rtl`, but with the model behind it and one pin wrong on some clocks:
// shows that the comparison counts what differs.
#include "gravure/emulator/rtl_board.hpp"
#include "gravure/fpga/gravure_fpga.h"

namespace {

struct Board {
  gravure_fpga_board* model = gravure_fpga_board_create(gravure::emulator::kRtlFifoBits);
  std::uint64_t clock = 0;
};

void* create() {
  return new Board;
}

void destroy(void* board) {
  gravure_fpga_board_destroy(static_cast<Board*>(board)->model);
  delete static_cast<Board*>(board);
}

void step(void* pointer, const gravure_fpga_board_inputs* inputs, gravure_fpga_board_outputs* outputs) {
  constexpr std::uint64_t kFirstWrong = 100;
  constexpr std::uint64_t kEvery = 7;
  Board& board = *static_cast<Board*>(pointer);
  gravure_fpga_board_step(board.model, inputs, outputs);
  ++board.clock;
  if (board.clock >= kFirstWrong && (board.clock - kFirstWrong) % kEvery == 0) {
    outputs->gate = outputs->gate == 0 ? 1 : 0;
  }
}

constexpr gravure::emulator::RtlModule kModule = {gravure::emulator::kRtlAbiVersion, create, step, destroy};

}  // namespace

extern "C" __attribute__((visibility("default"))) const gravure::emulator::RtlModule* gravure_rtl_module() {
  return &kModule;
}
