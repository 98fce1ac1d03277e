#pragma once

#include <cstdint>
#include <functional>

#include "gravure/fpga/ab_edges.hpp"
#include "gravure/fpga/ab_registers.hpp"

namespace gravure::fpga {

/// Gives every edge on clocks first < clock <= last to `on_edge`, in order, without storing any; the state after clock
/// `first` is no edge (position_after() tells it). `on_edge` returns false to stop. Returns what check() says of the
/// registers; with a refusal nothing is given.
AbRefusal stream_edges(const AbRegisters& registers, std::uint64_t first, std::uint64_t last,
                       const std::function<bool(const AbEdge&)>& on_edge);

}  // namespace gravure::fpga
