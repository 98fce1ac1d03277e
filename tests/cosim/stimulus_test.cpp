#include <gtest/gtest.h>

#include <algorithm>

#include "gravure/fpga/synchro.hpp"
#include "stimulus.hpp"

namespace gravure::cosim {
namespace {

/// Lock step proves nothing where the stimulus does not go.
TEST(HostStimulus, ReachesEveryFaultAndFiresManyLines) {
  const auto model = find_block("synchro")->model();
  Dice dice(1);
  const Stimulus stimulus = stimulus_for(*model);
  std::vector<std::uint64_t> in(model->inputs().size());
  std::vector<std::uint64_t> out(model->outputs().size());
  const auto seen = [&](const char* name) {
    const auto& ports = model->outputs();
    const auto port = std::find_if(ports.begin(), ports.end(), [name](const Port& p) { return p.name == name; });
    return out[static_cast<std::size_t>(port - ports.begin())];
  };
  std::uint64_t gate_moves = 0;
  std::uint64_t scans = 0;
  std::uint64_t before = 0;
  std::vector<std::uint64_t> clocks_with_fault(8);
  for (int clock = 0; clock < 2'000'000; ++clock) {
    stimulus(dice, in);
    model->step(in, out);
    gate_moves += seen("gate") != before ? 1 : 0;
    before = seen("gate");
    scans += seen("scan");
    ++clocks_with_fault[seen("fault")];
  }
  EXPECT_GT(gate_moves, 10'000U);
  EXPECT_GT(scans, 10'000U);
  EXPECT_GT(clocks_with_fault[0], 100'000U);
  for (std::size_t fault = 1; fault <= 6; ++fault) {
    EXPECT_GT(clocks_with_fault[fault], 0U) << "fault " << fault << " was never reached";
  }
}

}  // namespace
}  // namespace gravure::cosim
