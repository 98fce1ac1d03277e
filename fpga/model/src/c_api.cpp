#include <cstdint>
#include <new>

#include "gravure/fpga/ab_edges.hpp"
#include "gravure/fpga/gravure_fpga.h"
#include "gravure/fpga/synchro.hpp"

namespace fpga = gravure::fpga;

struct gravure_fpga_edges {
  fpga::AbEdges edges;
};
struct gravure_fpga_board {
  fpga::Synchro board;
};

namespace {

static_assert(static_cast<int>(fpga::AbRefusal::none) == GRAVURE_FPGA_OK);
static_assert(static_cast<int>(fpga::AbRefusal::bits) == GRAVURE_FPGA_BAD_BITS);
static_assert(static_cast<int>(fpga::AbRefusal::prescaler) == GRAVURE_FPGA_BAD_PRESCALER);
static_assert(static_cast<int>(fpga::AbRefusal::fraction_den) == GRAVURE_FPGA_BAD_FRACTION_DEN);
static_assert(static_cast<int>(fpga::AbRefusal::fraction_num) == GRAVURE_FPGA_BAD_FRACTION_NUM);
static_assert(static_cast<int>(fpga::AbRefusal::increment) == GRAVURE_FPGA_BAD_INCREMENT);

fpga::AbRegisters from_c(const gravure_fpga_registers& registers) noexcept {
  return {registers.bits, registers.prescaler, registers.increment, registers.fraction_num, registers.fraction_den};
}

std::uint8_t pin(bool level) noexcept {
  return level ? 1 : 0;
}

}  // namespace

gravure_fpga_refusal gravure_fpga_check(const gravure_fpga_registers* registers) {
  return static_cast<gravure_fpga_refusal>(fpga::check(from_c(*registers)));
}

gravure_fpga_refusal gravure_fpga_position_after(const gravure_fpga_registers* registers, std::uint64_t clock,
                                                 gravure_fpga_position* position) {
  const gravure_fpga_refusal refusal = gravure_fpga_check(registers);
  if (refusal == GRAVURE_FPGA_OK) {
    const fpga::AbPosition at = fpga::position_after(from_c(*registers), clock);
    *position = {static_cast<std::uint64_t>(at.counts >> 64U),
                 static_cast<std::uint64_t>(at.counts),
                 at.accumulator,
                 at.edges,
                 pin(at.pins.a),
                 pin(at.pins.b)};
  }
  return refusal;
}

gravure_fpga_edges* gravure_fpga_edges_create(const gravure_fpga_registers* registers, std::uint64_t clock) {
  auto edges = fpga::AbEdges::make(from_c(*registers));
  if (!edges) {
    return nullptr;
  }
  edges->seek(clock);
  return new (std::nothrow) gravure_fpga_edges{*edges};
}

int gravure_fpga_edges_next(gravure_fpga_edges* edges, gravure_fpga_edge* edge) {
  const auto next = edges->edges.next_edge();
  if (!next) {
    return 0;
  }
  *edge = {next->clock, pin(next->pins.a), pin(next->pins.b)};
  return 1;
}

void gravure_fpga_edges_destroy(gravure_fpga_edges* edges) {
  delete edges;
}

gravure_fpga_board* gravure_fpga_board_create(int fifo_bits) {
  if (fifo_bits < 4 || fifo_bits > 16) {
    return nullptr;
  }
  try {
    return new gravure_fpga_board{fpga::Synchro(fifo_bits)};
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void gravure_fpga_board_step(gravure_fpga_board* board, const gravure_fpga_board_inputs* inputs,
                             gravure_fpga_board_outputs* outputs) {
  fpga::Synchro::Inputs in;
  in.rst = inputs->rst != 0;
  in.write = inputs->write != 0;
  in.in_valid = inputs->in_valid != 0;
  in.start = inputs->start != 0;
  in.interlock = inputs->interlock != 0;
  in.index = inputs->index != 0;
  in.address = inputs->address;
  in.in_data = inputs->in_data;
  in.write_data = inputs->write_data;
  const fpga::Synchro::Outputs out = board->board.step(in);
  *outputs = {pin(out.a), pin(out.b),    pin(out.gate), pin(out.scan),
              out.fault,  out.read_data, pin(out.a_1),  pin(out.b_1)};
}

void gravure_fpga_board_destroy(gravure_fpga_board* board) {
  delete board;
}
