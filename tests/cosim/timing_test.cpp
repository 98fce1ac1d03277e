#include <gtest/gtest.h>

#include <filesystem>

#include "timing_table.hpp"

namespace gravure::cosim {
namespace {

class TimingTables : public testing::TestWithParam<std::string> {};

TEST_P(TimingTables, HoldForTheModel) {
  const TimingTable table = read_timing_table(GetParam());
  const Block* block = find_block(table.block);
  ASSERT_NE(block, nullptr) << "no block " << table.block;
  const auto machine = block->model();
  EXPECT_EQ(run_timing_table(table, *machine), "");
}

#ifdef GRAVURE_WITH_VERILATOR
TEST_P(TimingTables, HoldForTheRtl) {
  const TimingTable table = read_timing_table(GetParam());
  const auto machine = make_rtl(table.block);
  ASSERT_NE(machine, nullptr) << "no block " << table.block;
  EXPECT_EQ(run_timing_table(table, *machine), "");
}
#endif

INSTANTIATE_TEST_SUITE_P(All, TimingTables, testing::ValuesIn(timing_table_paths()),
                         [](const auto& tested) { return std::filesystem::path(tested.param).stem().string(); });

}  // namespace
}  // namespace gravure::cosim
