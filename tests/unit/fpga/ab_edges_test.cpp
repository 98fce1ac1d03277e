#include "gravure/fpga/ab_edges.hpp"

#include <gtest/gtest.h>

#include "edge_equality.hpp"

namespace gravure::fpga {
namespace {

using test::describe;
using test::EdgeHash;
using test::expect_same_edges_at_extremes;
using test::expect_same_edges_at_random;
using test::random_registers;
using test::random_seed;
using test::Words;

constexpr std::uint64_t kLastClock = ~std::uint64_t{0};

TEST(AbEdges, EqualsTheCounterAtExtremes) {
  expect_same_edges_at_extremes(20'000);
}

TEST(AbEdges, EqualsTheCounterAtRandomRegisters) {
  expect_same_edges_at_random(10'000, 600);
}

TEST(AbEdges, HasNoEdgesWhenStandingStill) {
  auto edges = AbEdges::make({.bits = 32, .increment = 0});
  ASSERT_TRUE(edges);
  EXPECT_FALSE(edges->next_edge());
  edges->seek(kLastClock);
  EXPECT_FALSE(edges->next_edge());
}

TEST(AbEdges, SeekContinuesLikeARunFromTheStart) {
  const std::uint64_t seed = random_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  Words words(seed);
  for (int trial = 0; trial < 2000; ++trial) {
    const AbRegisters registers = random_registers(words);
    SCOPED_TRACE(describe(registers));
    auto running = AbEdges::make(registers);
    auto seeking = AbEdges::make(registers);
    const std::uint64_t clock = words.below(20'000);
    running->run_to(clock, [](const AbEdge&) {});
    seeking->seek(clock);
    EXPECT_EQ(running->edges(), seeking->edges());
    for (int edge = 0; edge < 20; ++edge) {
      const auto a = running->next_edge();
      const auto b = seeking->next_edge();
      ASSERT_EQ(a.has_value(), b.has_value());
      if (a) {
        ASSERT_EQ(a->clock, b->clock);
        ASSERT_TRUE(a->pins == b->pins);
      }
    }
  }
}

/// At clocks no counter could be run to, every edge still is where the closed form changes.
TEST(AbEdges, AgreesWithTheClosedFormAtAnyClock) {
  const std::uint64_t seed = random_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  Words words(seed);
  for (int trial = 0; trial < 5000; ++trial) {
    const AbRegisters registers = random_registers(words);
    SCOPED_TRACE(describe(registers));
    auto edges = AbEdges::make(registers);
    edges->seek(trial % 2 == 0 ? words.of_any_length() : kLastClock - words.of_any_length() % 1000);
    for (int count = 0; count < 5; ++count) {
      const auto edge = edges->next_edge();
      if (!edge) {
        ASSERT_EQ(edges->edges(), position_after(registers, kLastClock).edges);
        break;
      }
      ASSERT_EQ(position_after(registers, edge->clock).edges, edges->edges());
      ASSERT_EQ(position_after(registers, edge->clock - 1).edges, edges->edges() - 1);
      ASSERT_TRUE(edge->pins == position_after(registers, edge->clock).pins);
    }
  }
}

TEST(AbEdges, ReachesTheLastClock) {
  const AbRegisters registers{.bits = 64, .prescaler = 1, .increment = std::uint64_t{1} << 62U};
  auto edges = AbEdges::make(registers);
  edges->seek(kLastClock - 2);
  EXPECT_EQ(edges->next_edge()->clock, kLastClock - 1);
  EXPECT_EQ(edges->next_edge()->clock, kLastClock);
  EXPECT_FALSE(edges->next_edge());
  EXPECT_EQ(edges->edges(), kLastClock);
  EXPECT_TRUE(position_after(registers, kLastClock).counts == static_cast<Uint128>(kLastClock) << 62U);
}

TEST(AbEdges, RunToStopsAtTheClockAndContinues) {
  const AbRegisters registers{.bits = 32, .prescaler = 3, .increment = 123'456'789};
  auto whole = AbEdges::make(registers);
  auto parts = AbEdges::make(registers);
  EdgeHash of_whole;
  EdgeHash of_parts;
  whole->run_to(10'000, [&](const AbEdge& edge) { of_whole.add(edge.clock, edge.pins); });
  for (std::uint64_t last = 0; last <= 10'000; last += 8) {
    parts->run_to(last, [&](const AbEdge& edge) {
      EXPECT_LE(edge.clock, last);
      of_parts.add(edge.clock, edge.pins);
    });
  }
  EXPECT_GT(of_whole.edges(), 300U);
  EXPECT_TRUE(of_whole == of_parts);
}

TEST(AbEdges, RunToGivesTheEdgesOfNextEdgeAnywhere) {
  const std::uint64_t seed = random_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  Words words(seed);
  for (int trial = 0; trial < 3000; ++trial) {
    const AbRegisters registers = random_registers(words);
    SCOPED_TRACE(describe(registers));
    auto running = AbEdges::make(registers);
    const std::uint64_t start = trial % 3 == 0 ? kLastClock - words.of_any_length() % 1000 : words.of_any_length();
    running->seek(start);
    auto stepping = *running;
    std::uint64_t last = start;
    EdgeHash by_step;
    for (int count = 0; count < 50; ++count) {
      if (const auto edge = stepping.next_edge(); edge) {
        by_step.add(edge->clock, edge->pins);
        last = edge->clock;
      }
    }
    EdgeHash by_run;
    running->run_to(last, [&](const AbEdge& edge) { by_run.add(edge.clock, edge.pins); });
    ASSERT_EQ(by_step.edges(), by_run.edges());
    ASSERT_TRUE(by_step == by_run);
    ASSERT_EQ(stepping.edges(), running->edges());
    const auto a = stepping.next_edge();
    const auto b = running->next_edge();
    ASSERT_EQ(a ? a->clock : 0, b ? b->clock : 0);
  }
}

TEST(AbEdges, RefusesWhatTheBoardWouldRefuse) {
  EXPECT_FALSE(AbEdges::make({.bits = 32, .increment = (1U << 30U) + 1}));
  EXPECT_FALSE(AbEdges::make({.bits = 32, .prescaler = 0, .increment = 1}));
}

}  // namespace
}  // namespace gravure::fpga
