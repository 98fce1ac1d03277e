#include "gravure/fpga/edge_stream.hpp"

namespace gravure::fpga {

AbRefusal stream_edges(const AbRegisters& registers, std::uint64_t first, std::uint64_t last,
                       const std::function<bool(const AbEdge&)>& on_edge) {
  auto edges = AbEdges::make(registers);
  if (!edges) {
    return check(registers);
  }
  edges->seek(first);
  for (auto edge = edges->next_edge(); edge && edge->clock <= last; edge = edges->next_edge()) {
    if (!on_edge(*edge)) {
      break;
    }
  }
  return AbRefusal::none;
}

}  // namespace gravure::fpga
