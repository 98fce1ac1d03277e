#include <verilated.h>

#include "Vsynchro.h"
#include "gravure/emulator/rtl_board.hpp"

namespace {

struct Board {
  VerilatedContext context;
  Vsynchro top{&context};
  bool seed_edge = true;
};

void* create() {
  return new Board;
}

void destroy(void* board) {
  delete static_cast<Board*>(board);
}

void step(void* pointer, const gravure_fpga_board_inputs* in, gravure_fpga_board_outputs* out) {
  Board& board = *static_cast<Board*>(pointer);
  Vsynchro& top = board.top;
  top.rst = in->rst != 0;
  top.write = in->write != 0;
  top.in_valid = in->in_valid != 0;
  top.start = in->start != 0;
  top.index = in->index != 0;
  top.interlock = in->interlock != 0;
  top.address = in->address;
  top.in_data = in->in_data;
  top.write_data = in->write_data;
  top.clk_fast = 1;
  top.clk = board.seed_edge ? 1 : 0;
  top.eval();
  top.clk_fast = 0;
  top.clk = 0;
  top.eval();
  board.seed_edge = !board.seed_edge;
  *out = {top.a, top.b, top.gate, top.scan, top.fault, top.read_data, top.a_1, top.b_1};
}

constexpr gravure::emulator::RtlModule kModule = {gravure::emulator::kRtlAbiVersion, create, step, destroy};

}  // namespace

extern "C" __attribute__((visibility("default"))) const gravure::emulator::RtlModule* gravure_rtl_module() {
  return &kModule;
}
