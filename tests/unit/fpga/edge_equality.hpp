#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "gravure/fpga/ab_counter.hpp"
#include "gravure/fpga/ab_edges.hpp"
#include "random_registers.hpp"

namespace gravure::fpga::test {

inline std::string describe(const AbRegisters& r) {
  return "bits " + std::to_string(r.bits) + ", prescaler " + std::to_string(r.prescaler) + ", increment " +
         std::to_string(r.increment) + ", fraction " + std::to_string(r.fraction_num) + "/" +
         std::to_string(r.fraction_den);
}

/// AbEdges and AbCounter show the same pins over `clocks` clocks, and end where position_after() says.
inline void expect_same_edges(const AbRegisters& registers, std::uint64_t clocks) {
  SCOPED_TRACE(describe(registers));
  auto counter = AbCounter::make(registers);
  auto edges = AbEdges::make(registers);
  ASSERT_TRUE(counter && edges);
  EdgeHash by_clock;
  AbPins before;
  for (std::uint64_t clock = 1; clock <= clocks; ++clock) {
    const AbPins now = counter->step();
    if (!(now == before)) {
      by_clock.add(clock, now);
      before = now;
    }
  }
  EdgeHash by_edge;
  edges->run_to(clocks, [&by_edge](const AbEdge& edge) { by_edge.add(edge.clock, edge.pins); });
  EXPECT_EQ(by_clock.edges(), by_edge.edges());
  EXPECT_TRUE(by_clock == by_edge);
  const AbPosition position = position_after(registers, clocks);
  const std::uint64_t mask = ~std::uint64_t{0} >> static_cast<unsigned>(64 - registers.bits);
  EXPECT_EQ(static_cast<std::uint64_t>(position.counts) & mask, counter->counter());
  EXPECT_EQ(position.accumulator, counter->accumulator());
  EXPECT_EQ(position.edges, by_edge.edges());
  EXPECT_TRUE(position.pins == counter->pins());
}

/// Every extreme the registers have, each over `clocks` clocks.
inline void expect_same_edges_at_extremes(std::uint64_t clocks) {
  for (const int bits : {8, 16, 32, 48, 64}) {
    for (const std::uint64_t prescaler : {1U, 2U, 3U, 7U, 70'001U}) {
      for (const bool fraction : {false, true}) {
        AbRegisters registers{.bits = bits, .prescaler = prescaler};
        if (fraction) {
          registers.fraction_den = ~std::uint64_t{0};
          registers.fraction_num = registers.fraction_den / 3 * 2;
        }
        const std::uint64_t top = max_increment(registers);
        for (const std::uint64_t increment :
             {std::uint64_t{1}, std::uint64_t{77}, std::uint64_t{2'109'497}, top - 1, top}) {
          registers.increment = increment;
          if (increment <= top) {
            expect_same_edges(registers, clocks);
          }
        }
      }
    }
  }
}

inline void expect_same_edges_at_random(std::uint64_t clocks, int trials) {
  const std::uint64_t seed = random_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  Words words(seed);
  for (int trial = 0; trial < trials; ++trial) {
    expect_same_edges(random_registers(words), clocks);
  }
}

}  // namespace gravure::fpga::test
