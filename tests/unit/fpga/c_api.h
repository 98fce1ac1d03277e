#ifndef GRAVURE_TESTS_C_API_H
#define GRAVURE_TESTS_C_API_H

#include "gravure/fpga/gravure_fpga.h"

#ifdef __cplusplus
extern "C" {
#endif

extern const gravure_fpga_registers c_published; /* [B]: 6 bits, m = 3, increment 7 */
/* Edges later than `first`, up to `last`, at most `most`; -1 where the registers are refused. */
int c_count_edges(const gravure_fpga_registers* registers, uint64_t first, uint64_t last, gravure_fpga_edge* edges,
                  int most);
/* What a fresh board has at an address; 0 where there is no such board. */
int c_read(int fifo_bits, uint8_t address, uint32_t* data);
/* Changes of the axis pins in some clocks after the axis is enabled. */
int c_axis_edges(uint32_t increment, int clocks);

#ifdef __cplusplus
}
#endif

#endif
