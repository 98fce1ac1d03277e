#include "gravure/fpga/synchro_events.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "blocks.hpp"
#include "dice.hpp"
#include "event_pair.hpp"
#include "host_stimulus.hpp"
#include "ports.hpp"
#include "slow_host.hpp"

namespace gravure::fpga {
namespace {

using test::EventPair;

/// What the host of the co-simulation does, as runs of equal inputs: what idle pins show changes rarely.
class Host {
 public:
  explicit Host(std::uint64_t seed) : dice_(seed), stimulus_(board_.inputs()), values_(board_.inputs().size()) {}

  /// The inputs of the next seed clock.
  Synchro::Inputs next() {
    stimulus_(dice_, values_);
    stimulus_(dice_, values_);  // the second FPGA clock of it
    Synchro::Inputs in;
    cosim::SynchroPorts::in(in, cosim::PortDriver(values_));
    if (!in.write && !in.in_valid) {
      in.in_data = 0;
      in.write_data = 0;
      idle_address_ = dice_.one_in(30) ? in.address : idle_address_;
      in.address = idle_address_;
    }
    return in;
  }
  cosim::Dice& dice() { return dice_; }

 private:
  cosim::Dice dice_;
  cosim::ModelMachine<cosim::SynchroPorts> board_;  // for the names of its ports
  cosim::HostStimulus stimulus_;
  std::vector<std::uint64_t> values_;
  std::uint8_t idle_address_ = kFifoLevelRegister.address;
};

void run_host(EventPair& pair, std::uint64_t clocks, std::uint64_t gap_rarity) {
  Host host(gravure::test::Dice::seed());
  Synchro::Inputs held = host.next();
  std::uint64_t length = 0;
  while (pair.clock() < clocks) {
    length += 2;
    const Synchro::Inputs next = host.next();
    if (!held.write && !held.in_valid && !held.rst && host.dice().one_in(gap_rarity)) {
      length += host.dice().word() % (host.dice().one_in(20) ? 30'000 : 700) * 2;
    }
    if (!(next == held)) {
      ASSERT_TRUE(pair.run(held, length));
      held = next;
      length = 0;
    }
  }
}

constexpr unsigned kEveryFault = 0x7F;

TEST(SynchroEvents, IsTheBoardClockByClockUnderARandomHost) {
  SCOPED_TRACE(gravure::test::Dice::note());
  EventPair pair;
  run_host(pair, 1'000'000, ~std::uint64_t{0});
  EXPECT_GT(pair.seen(), 100'000U);
}

TEST(SynchroEvents, IsTheBoardClockByClockUnderAHostThatOftenWaits) {
  SCOPED_TRACE(gravure::test::Dice::note());
  EventPair pair;
  run_host(pair, 2'000'000, 40);
  EXPECT_GT(pair.seen(), 100'000U);
  EXPECT_LT(pair.stepped(), pair.clock() / 2) << "nothing was jumped over";
}

TEST(SynchroEvents, IsTheBoardClockByClockWhereSlotsAreLong) {
  SCOPED_TRACE(gravure::test::Dice::note());
  EventPair pair;
  test::SlowHost host(pair, gravure::test::Dice::seed());
  while (pair.clock() < 5'000'000) {
    ASSERT_TRUE(host.run_job());
  }
  EXPECT_EQ(pair.faults() | 8U, kEveryFault);
  EXPECT_GT(pair.cuts(), 20U);
  EXPECT_GT(pair.executed_lines(), 100U);
  EXPECT_LT(pair.stepped(), pair.clock() / 5) << "nothing was jumped over";
}

TEST(SynchroEvents, HoldsInputsForAnyNumberOfClocks) {
  SCOPED_TRACE(gravure::test::Dice::note());
  gravure::test::Dice dice;
  EventPair pair;
  Synchro::Inputs in;
  for (int trial = 0; trial < 3000; ++trial) {  // odd runs too: inputs count where a seed clock finds them
    in.write = dice.between(0, 9) == 0;
    in.address = static_cast<std::uint8_t>(dice.between(0x10, 0x30));
    in.write_data = static_cast<std::uint32_t>(dice.between(0, 15));
    ASSERT_TRUE(pair.run(in, static_cast<std::uint64_t>(dice.between(0, in.write ? 3 : 200))));
  }
}

}  // namespace
}  // namespace gravure::fpga
