#include "edge_equality.hpp"

namespace gravure::fpga::test {
namespace {

/// 220 register sets; together with the random ones more than 1e9 clocks.
TEST(AbEdgesAtLength, EqualsTheCounterAtExtremes) {
  expect_same_edges_at_extremes(2'500'000);
}

TEST(AbEdgesAtLength, EqualsTheCounterAtRandomRegisters) {
  expect_same_edges_at_random(2'000'000, 300);
}

}  // namespace
}  // namespace gravure::fpga::test
