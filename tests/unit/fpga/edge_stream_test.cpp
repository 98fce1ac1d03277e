#include "gravure/fpga/edge_stream.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace gravure::fpga {
namespace {

constexpr AbRegisters kPublished{.bits = 6, .prescaler = 3, .increment = 7};

std::vector<std::uint64_t> clocks_of(std::uint64_t first, std::uint64_t last, std::size_t most = 100) {
  std::vector<std::uint64_t> clocks;
  EXPECT_EQ(stream_edges(kPublished, first, last,
                         [&](const AbEdge& edge) {
                           clocks.push_back(edge.clock);
                           return clocks.size() < most;
                         }),
            AbRefusal::none);
  return clocks;
}

TEST(StreamEdges, GivesThePublishedEdges) {
  EXPECT_EQ(clocks_of(0, 36), (std::vector<std::uint64_t>{9, 15, 21, 30, 36}));
}

TEST(StreamEdges, LeavesTheFirstClockOutAndTakesTheLast) {
  EXPECT_EQ(clocks_of(9, 21), (std::vector<std::uint64_t>{15, 21}));
  EXPECT_EQ(clocks_of(8, 20), (std::vector<std::uint64_t>{9, 15}));
  EXPECT_TRUE(clocks_of(36, 36).empty());
  EXPECT_TRUE(clocks_of(36, 9).empty());
}

TEST(StreamEdges, StopsWhenToldTo) {
  EXPECT_EQ(clocks_of(0, 36, 2), (std::vector<std::uint64_t>{9, 15}));
}

TEST(StreamEdges, GivesNothingWhereTheRegistersAreRefused) {
  const auto never = [](const AbEdge&) {
    ADD_FAILURE();
    return true;
  };
  EXPECT_EQ(stream_edges({.bits = 6, .prescaler = 3, .increment = 17}, 0, 36, never), AbRefusal::increment);
}

}  // namespace
}  // namespace gravure::fpga
