/* The FPGA model for C and every language that can call it. C99; nothing but the standard library behind it.
 *
 * The A-B counter in closed form and from edge to edge, and the whole board clock by clock. Nothing here throws, prints
 * or keeps state of its own; one object belongs to one thread at a time. A, B and the other pins are 0 or 1. */
#ifndef GRAVURE_FPGA_H
#define GRAVURE_FPGA_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Registers of one A-B channel; AbRegisters in ab_registers.hpp says what they do. */
typedef struct gravure_fpga_registers {
  int bits;              /* n, 4 to 64 */
  uint64_t prescaler;    /* m, 1 or more */
  uint64_t increment;    /* with the largest carry at most 2^(bits-2) */
  uint64_t fraction_num; /* less than fraction_den; 0 turns the fraction off */
  uint64_t fraction_den; /* 1 or more */
} gravure_fpga_registers;

/* The first register that the board would not take. */
typedef enum gravure_fpga_refusal {
  GRAVURE_FPGA_OK = 0,
  GRAVURE_FPGA_BAD_BITS = 1,
  GRAVURE_FPGA_BAD_PRESCALER = 2,
  GRAVURE_FPGA_BAD_FRACTION_DEN = 3,
  GRAVURE_FPGA_BAD_FRACTION_NUM = 4,
  GRAVURE_FPGA_BAD_INCREMENT = 5
} gravure_fpga_refusal;

gravure_fpga_refusal gravure_fpga_check(const gravure_fpga_registers* registers);

/* Where a channel stands after some clock since reset. */
typedef struct gravure_fpga_position {
  uint64_t counts_high; /* the counter that never wraps: counts_high 2^64 + counts_low */
  uint64_t counts_low;
  uint64_t accumulator; /* of the fraction */
  uint64_t edges;       /* A-B edges put out */
  uint8_t a;
  uint8_t b;
} gravure_fpga_position;

/* In closed form, at any clock. With a refusal `position` is left as it is. */
gravure_fpga_refusal gravure_fpga_position_after(const gravure_fpga_registers* registers, uint64_t clock,
                                                 gravure_fpga_position* position);

/* One change of a pin; exactly one of A and B changed. */
typedef struct gravure_fpga_edge {
  uint64_t clock; /* the first clock after which the pins show this; clocks count from 1 */
  uint8_t a;
  uint8_t b;
} gravure_fpga_edge;

typedef struct gravure_fpga_edges gravure_fpga_edges;

/* The edges later than `clock`, in order. Null where gravure_fpga_check() refuses the registers or memory is out. */
gravure_fpga_edges* gravure_fpga_edges_create(const gravure_fpga_registers* registers, uint64_t clock);
/* 1 and the next edge; 0 where none is left up to clock 2^64 - 1. */
int gravure_fpga_edges_next(gravure_fpga_edges* edges, gravure_fpga_edge* edge);
void gravure_fpga_edges_destroy(gravure_fpga_edges* edges);

/* The whole board. docs/registers.md has its registers, Synchro in synchro.hpp its clocks: every second step, the
 * first included, is an edge of the seed clock too, and inputs are looked at then only. */
typedef struct gravure_fpga_board_inputs {
  uint8_t rst;
  uint8_t write; /* writes write_data to the register at address */
  uint8_t address;
  uint32_t write_data;
  uint8_t in_valid; /* a byte of a frame */
  uint8_t in_data;
  uint8_t start; /* the line-start strobe */
  uint8_t interlock;
  uint8_t index; /* of the encoder */
} gravure_fpga_board_inputs;

typedef struct gravure_fpga_board_outputs {
  uint8_t a;
  uint8_t b;
  uint8_t gate;
  uint8_t scan;
  uint8_t fault;      /* 0 none, 1 sequence, 2 checksum, 3 shape, 4 underrun, 5 host silence, 6 interlock */
  uint32_t read_data; /* of the register at address, two seed clocks later */
  uint8_t a_1;        /* the second axis */
  uint8_t b_1;
} gravure_fpga_board_outputs;

typedef struct gravure_fpga_board gravure_fpga_board;

/* The line FIFO holds 2^fifo_bits bytes, 4 to 16. Null where fifo_bits is another or memory is out. */
gravure_fpga_board* gravure_fpga_board_create(int fifo_bits);
/* One rising edge of the FPGA clock; `outputs` as they stand just after it. */
void gravure_fpga_board_step(gravure_fpga_board* board, const gravure_fpga_board_inputs* inputs,
                             gravure_fpga_board_outputs* outputs);
void gravure_fpga_board_destroy(gravure_fpga_board* board);

#ifdef __cplusplus
}
#endif

#endif
