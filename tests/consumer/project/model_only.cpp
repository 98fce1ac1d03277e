// Built by pkg-config: the FPGA model needs nothing but the standard library.
#include "gravure/fpga/ab_counter.hpp"
#include "gravure/fpga/ab_edges.hpp"

int main() {
  auto edges = gravure::fpga::AbEdges::make({.bits = 6, .prescaler = 3, .increment = 7});
  return edges && edges->next_edge()->clock == 9 ? 0 : 1;
}
