#pragma once

#include <cstdint>

namespace gravure::bench {

/// What was seen on A and B: the same numbers mean the same edges on the same clocks.
struct EdgeSum {
  std::uint64_t hash = 0;
  std::uint64_t edges = 0;
  void take(std::uint64_t clock, bool a, bool b) {
    hash = hash * 3 + clock * 4 + (a ? 2U : 0U) + (b ? 1U : 0U);
    ++edges;
  }
};

/// Runs fpga/rtl/ab_generator.v (32 bits, prescaler 1, no fraction) under Verilator until its counter has counted
/// `clocks`; clocks are those of the counter. Compiled with -O3 -flto.
EdgeSum run_rtl_counter(std::uint32_t increment, std::uint64_t clocks);

}  // namespace gravure::bench
