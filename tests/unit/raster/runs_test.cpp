#include "gravure/raster/runs.hpp"

#include "raster_support.hpp"

namespace gravure::raster {
namespace {

std::vector<std::uint32_t> edges_bit_by_bit(const Bytes& line, std::int64_t width) {
  std::vector<std::uint32_t> edges;
  bool before = false;
  for (std::int64_t k = 0; k <= width; ++k) {
    const bool now = k < width && get_bit(line, k);
    if (now != before) {
      edges.push_back(static_cast<std::uint32_t>(k));
    }
    before = now;
  }
  return edges;
}

class Runs : public KernelTest {};
INSTANTIATE_TEST_SUITE_P(Raster, Runs, kEveryIsa, kIsaName);

TEST_P(Runs, EqualBitByBitAndAreAppended) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  for (int trial = 0; trial < 20000; ++trial) {
    const std::int64_t width = dice.size(5000);
    const Bytes line = dice.bytes(packed_bytes(width));
    std::vector<std::uint32_t> expected{7, 8};
    std::vector<std::uint32_t> edges = expected;
    const std::vector<std::uint32_t> reference = edges_bit_by_bit(line, width);
    expected.insert(expected.end(), reference.begin(), reference.end());
    kernels().append_runs(line, width, edges);
    ASSERT_EQ(edges, expected) << "width " << width;
    ASSERT_EQ(edges.size() % 2, 0u);
  }
}

TEST_P(Runs, FindEveryEdgeOfTheDensestAndTheEmptiestLine) {
  for (std::int64_t width = 0; width <= 1100; ++width) {
    for (const unsigned pattern : {0x00u, 0xFFu, 0xAAu, 0x55u}) {
      const Bytes line(static_cast<std::size_t>(packed_bytes(width)), static_cast<std::byte>(pattern));
      std::vector<std::uint32_t> edges;
      kernels().append_runs(line, width, edges);
      ASSERT_EQ(edges, edges_bit_by_bit(line, width)) << "width " << width << ", pattern " << pattern;
    }
  }
}

TEST(Runs, AreGivenOneByOneWithTheirLength) {
  const Bytes line{std::byte{0b0110'0001}, std::byte{0b1000'0011}};
  std::vector<std::pair<std::int64_t, std::int64_t>> runs;
  for_each_run(line, 15, [&runs](std::int64_t first, std::int64_t length) { runs.emplace_back(first, length); });
  EXPECT_EQ(runs, (std::vector<std::pair<std::int64_t, std::int64_t>>{{1, 2}, {7, 2}, {14, 1}}));
}

}  // namespace
}  // namespace gravure::raster
