#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "gravure/fpga/synchro.hpp"
#include "stimulus.hpp"

namespace gravure::cosim {
namespace {

/// Lock step proves nothing where the stimulus does not go.
TEST(HostStimulus, ReachesEveryFaultFiresManyLinesAndReadsHowFarTheyCame) {
  const auto model = find_block("synchro")->model();
  Dice dice(1);
  const Stimulus stimulus = stimulus_for(*model);
  std::vector<std::uint64_t> in(model->inputs().size());
  std::vector<std::uint64_t> out(model->outputs().size());
  const std::size_t address_at = 6;
  ASSERT_EQ(model->inputs()[address_at].name, "address");
  const auto seen = [&](const char* name) {
    const auto& ports = model->outputs();
    const auto port = std::find_if(ports.begin(), ports.end(), [name](const Port& p) { return p.name == name; });
    return out[static_cast<std::size_t>(port - ports.begin())];
  };
  std::uint64_t gate_moves = 0;
  std::uint64_t scans = 0;
  std::uint64_t before = 0;
  std::uint64_t address = 0;  ///< of the seed clock before
  std::uint64_t asked = 0;    ///< and of the one before that, which is answered now
  std::uint64_t most_lines = 0;
  std::uint64_t cuts_read = 0;
  std::vector<std::uint64_t> clocks_with_fault(8);
  for (int clock = 0; clock < 2'000'000; ++clock) {
    stimulus(dice, in);
    model->step(in, out);
    gate_moves += seen("gate") != before ? 1 : 0;
    before = seen("gate");
    scans += seen("scan");
    ++clocks_with_fault[seen("fault")];
    if (clock % 2 == 0) {
      asked = std::exchange(address, in[address_at]);
      most_lines = asked == fpga::kExecutedLinesRegister.address ? std::max(most_lines, seen("read_data")) : most_lines;
      const bool cut = (seen("read_data") & fpga::LineProgress::kPartialBit) != 0;
      cuts_read += asked == fpga::kClosedSlotRegister.address && cut ? 1 : 0;
    }
  }
  EXPECT_GT(gate_moves, 10'000U);
  EXPECT_GT(scans, 10'000U);
  EXPECT_GT(clocks_with_fault[0], 100'000U);
  EXPECT_GT(most_lines, 5U);
  EXPECT_GT(cuts_read, 1000U);
  for (std::size_t fault = 1; fault <= 6; ++fault) {
    EXPECT_GT(clocks_with_fault[fault], 0U) << "fault " << fault << " was never reached";
  }
}

}  // namespace
}  // namespace gravure::cosim
