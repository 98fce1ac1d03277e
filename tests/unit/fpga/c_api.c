/* What a C program makes of the header. Compiled as C99. */
#include "c_api.h"

#include <string.h>

const gravure_fpga_registers c_published = {6, 3, 7, 0, 1};

int c_count_edges(const gravure_fpga_registers* registers, uint64_t first, uint64_t last, gravure_fpga_edge* edges,
                  int most) {
  gravure_fpga_edge edge;
  int count = 0;
  gravure_fpga_edges* walk = gravure_fpga_edges_create(registers, first);
  if (walk == NULL) {
    return -1;
  }
  while (count < most && gravure_fpga_edges_next(walk, &edge) == 1 && edge.clock <= last) {
    edges[count++] = edge;
  }
  gravure_fpga_edges_destroy(walk);
  return count;
}

static void c_write(gravure_fpga_board* board, uint8_t address, uint32_t data, gravure_fpga_board_outputs* out) {
  gravure_fpga_board_inputs in;
  memset(&in, 0, sizeof in);
  in.write = 1;
  in.address = address;
  in.write_data = data;
  gravure_fpga_board_step(board, &in, out);
  gravure_fpga_board_step(board, &in, out);
}

int c_read(int fifo_bits, uint8_t address, uint32_t* data) {
  gravure_fpga_board_inputs in;
  gravure_fpga_board_outputs out;
  int clock;
  gravure_fpga_board* board = gravure_fpga_board_create(fifo_bits);
  if (board == NULL) {
    return 0;
  }
  memset(&in, 0, sizeof in);
  in.address = address;
  for (clock = 0; clock < 6; ++clock) {
    gravure_fpga_board_step(board, &in, &out);
  }
  *data = out.read_data;
  gravure_fpga_board_destroy(board);
  return 1;
}

int c_axis_edges(uint32_t increment, int clocks) {
  gravure_fpga_board_inputs in;
  gravure_fpga_board_outputs out;
  int edges = 0;
  int clock;
  int before = 0;
  gravure_fpga_board* board = gravure_fpga_board_create(12);
  c_write(board, 0x20, increment, &out);
  c_write(board, 0x11, 2, &out);
  c_write(board, 0x10, 2, &out);
  memset(&in, 0, sizeof in);
  for (clock = 0; clock < clocks; ++clock) {
    gravure_fpga_board_step(board, &in, &out);
    edges += out.a * 2 + out.b != before;
    before = out.a * 2 + out.b;
  }
  gravure_fpga_board_destroy(board);
  return edges;
}
