#include "fpga_rtl_counter.hpp"

#include <verilated.h>

#include "Vab_generator.h"
#include "gravure/fpga/ab_generator.hpp"

namespace gravure::bench {

EdgeSum run_rtl_counter(std::uint32_t increment, std::uint64_t clocks) {
  VerilatedContext context;
  Vab_generator top(&context);
  const auto clock = [&top](bool seed) {
    top.clk_fast = 1;
    top.clk = seed ? 1 : 0;
    top.eval();
    top.clk_fast = 0;
    top.clk = 0;
    top.eval();
  };
  top.rst = 1;
  for (int count = 0; count < 8; ++count) {
    clock(count % 2 == 0);
  }
  top.rst = 0;
  top.enable = 1;
  top.increment = increment;
  top.prescaler = 1;
  top.fraction_num = 0;
  top.fraction_den = 1;
  top.load = 1;
  clock(true);
  clock(false);
  top.load = 0;
  constexpr auto kLatency = static_cast<std::uint64_t>(fpga::AbGenerator::load_latency({}));
  EdgeSum sum;
  bool a = false;
  bool b = false;
  for (std::uint64_t now = 2; now <= clocks + kLatency; ++now) {  // clocks after the one that took the load
    clock(now % 2 == 0);
    if ((top.a != 0) != a || (top.b != 0) != b) {
      a = top.a != 0;
      b = top.b != 0;
      sum.take(now - kLatency, a, b);
    }
  }
  top.final();
  return sum;
}

}  // namespace gravure::bench
