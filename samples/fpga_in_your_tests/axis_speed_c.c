/* The same question in C: after an hour, in closed form. */
#include <gravure/fpga/gravure_fpga.h>
#include <stdio.h>

int main(void) {
  const gravure_fpga_registers registers = {32, 1, 1 << 21, 0, 1};
  gravure_fpga_position position = {0};
  const gravure_fpga_refusal refusal = gravure_fpga_position_after(&registers, UINT64_C(3600) * 164000000, &position);
  printf("%llu edges in an hour\n", (unsigned long long)position.edges);
  return refusal == GRAVURE_FPGA_OK && position.edges == UINT64_C(1153125000) ? 0 : 1;
}
