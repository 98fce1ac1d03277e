#include "c_api.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace {

TEST(CApi, GivesThePublishedEdges) {
  std::array<gravure_fpga_edge, 10> edges{};
  ASSERT_EQ(c_count_edges(&c_published, 0, 36, edges.data(), 10), 5);
  const std::array<std::uint64_t, 5> clocks = {9, 15, 21, 30, 36};
  for (std::size_t at = 0; at < clocks.size(); ++at) {
    EXPECT_EQ(edges.at(at).clock, clocks.at(at));
  }
  EXPECT_EQ(edges[0].a, 0);
  EXPECT_EQ(edges[0].b, 1);
  EXPECT_EQ(c_count_edges(&c_published, 15, 36, edges.data(), 10), 3) << "edges later than clock 15";
}

TEST(CApi, KnowsThePositionAtAnyClock) {
  gravure_fpga_position position{};
  ASSERT_EQ(gravure_fpga_position_after(&c_published, 36, &position), GRAVURE_FPGA_OK);
  EXPECT_EQ(position.edges, 5U);
  EXPECT_EQ(position.counts_low, 84U);
  EXPECT_EQ(position.counts_high, 0U);
  EXPECT_EQ(position.a, 0);
  EXPECT_EQ(position.b, 1);
}

TEST(CApi, RefusesWhatTheBoardWould) {
  const auto refusal = [](gravure_fpga_registers registers) {
    gravure_fpga_position position{};
    EXPECT_EQ(gravure_fpga_edges_create(&registers, 0), nullptr);
    EXPECT_EQ(gravure_fpga_position_after(&registers, 1, &position), gravure_fpga_check(&registers));
    return gravure_fpga_check(&registers);
  };
  EXPECT_EQ(gravure_fpga_check(&c_published), GRAVURE_FPGA_OK);
  EXPECT_EQ(refusal({65, 1, 1, 0, 1}), GRAVURE_FPGA_BAD_BITS);
  EXPECT_EQ(refusal({32, 0, 1, 0, 1}), GRAVURE_FPGA_BAD_PRESCALER);
  EXPECT_EQ(refusal({32, 1, 1, 0, 0}), GRAVURE_FPGA_BAD_FRACTION_DEN);
  EXPECT_EQ(refusal({32, 1, 1, 2, 2}), GRAVURE_FPGA_BAD_FRACTION_NUM);
  EXPECT_EQ(refusal({32, 1, (1U << 30U) + 1, 0, 1}), GRAVURE_FPGA_BAD_INCREMENT);
}

TEST(CApi, StepsTheBoard) {
  std::uint32_t magic = 0;
  ASSERT_EQ(c_read(12, 0x00, &magic), 1);
  EXPECT_EQ(magic, 0x47524156U);
  std::uint32_t version = 0;
  ASSERT_EQ(c_read(12, 0x01, &version), 1);
  EXPECT_EQ(version, 4U);
  EXPECT_EQ(c_read(3, 0x00, &magic), 0);
  EXPECT_EQ(c_read(17, 0x00, &magic), 0);
  EXPECT_EQ(c_axis_edges(0, 10'000), 0);
  const int edges = c_axis_edges(1U << 21U, 512 * 100);
  EXPECT_GE(edges, 99);  // 2^30 / 2^21 = 512 clocks an edge, less what the load takes
  EXPECT_LE(edges, 100);
}

}  // namespace
