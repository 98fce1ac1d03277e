#include "gravure/emulator/board_host.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "gravure/emulator/rtl_board.hpp"
#include "gravure/fpga/ab_edges.hpp"
#include "gravure/fpga/synchro_events.hpp"
#include "recorder.hpp"

namespace gravure::emulator {
namespace {

/// 3 revolutions of 4 lines of 120 slots of 4 ticks, 13 of them in the window.
DeviceSetup board_setup() {
  DeviceSetup setup = test::small_setup();
  setup.counter_bits = 32;
  setup.increment = 700'000'000;
  setup.slots_per_line = 120;
  setup.clock_multiplier = 2;
  setup.ticks_per_slot = 4;
  return setup;
}

/// The model of the board behind the wires of a host.
class BoardHostOnModel : public testing::Test {
 protected:
  struct Opening {
    std::uint64_t clock;
    std::uint64_t clocks;
  };
  Result<void> hold(const fpga::Synchro::Inputs& inputs, std::uint64_t clocks) {
    board_.run(inputs, clocks, [this](const fpga::SynchroEvents::Event& now) {
      edges_ += now.axes[0] == before_.axes[0] ? 0 : 1;
      carriage_edges_ += now.axes[1] == before_.axes[1] ? 0 : 1;
      if (now.gate && !before_.gate) {
        openings_.push_back({now.clock, 0});
      } else if (!now.gate && before_.gate) {
        openings_.back().clocks = now.clock - openings_.back().clock;
      }
      before_ = now;
    });
    return {};
  }
  fpga::SynchroEvents board_{kRtlFifoBits};
  fpga::SynchroEvents::Event before_;
  std::vector<Opening> openings_;
  std::uint64_t edges_ = 0;
  std::uint64_t carriage_edges_ = 0;
  BoardHost host_{kRtlFifoBits,
                  [this](const fpga::Synchro::Inputs& inputs, std::uint64_t clocks) { return hold(inputs, clocks); }};
};

TEST_F(BoardHostOnModel, OpensTheGateForTheSlotsOfEveryLine) {
  ASSERT_TRUE(host_.start_lines(board_setup(), {.slots_per_microvector = 5}));
  for (std::int64_t line = 0; line < 12; ++line) {
    test::Frame frame(line / 4, line % 4);
    ASSERT_TRUE(host_.send(*frame));
  }
  ASSERT_TRUE(host_.finish());
  EXPECT_EQ(before_.fault, 0);
  ASSERT_TRUE(host_.close());
  // 0x81 + revolution, then 0xF8 - 8 line: runs of slots that fire, and where they begin.
  std::vector<Opening> expected;
  for (std::uint64_t line = 0; line < 12; ++line) {
    const std::uint64_t bits = ((0x81 + line / 4) << 8U) | (0xF8 - 8 * (line % 4));
    for (std::uint64_t slot = 0; slot < 13; ++slot) {
      const bool fires = ((bits >> (15 - slot)) & 1U) != 0;
      const bool fired = slot != 0 && ((bits >> (16 - slot)) & 1U) != 0;
      if (fires && !fired) {
        expected.push_back({(line * 120 + 3 + line % 4 + slot) * 4, 0});
      }
      expected.back().clocks += fires ? 4 : 0;
    }
  }
  ASSERT_EQ(openings_.size(), expected.size());
  const std::uint64_t start = openings_[0].clock - expected[0].clock;  // tick 0 of the job, in clocks of the board
  for (std::size_t at = 0; at < expected.size(); ++at) {
    EXPECT_EQ(openings_[at].clock, start + expected[at].clock) << at;
    EXPECT_EQ(openings_[at].clocks, expected[at].clocks) << at;
  }
}

/// Where the gate opened first in every line, in clocks from where that of line 0 did; lines fire from slot 3 + line
/// on.
std::vector<std::uint64_t> line_starts(const std::vector<std::uint64_t>& openings, std::uint64_t line_clocks) {
  std::vector<std::uint64_t> starts;
  for (const std::uint64_t clock : openings) {
    const std::uint64_t after = clock - openings.front();
    if (starts.empty() || after / line_clocks > starts.back() / line_clocks) {
      starts.push_back(after);
    }
  }
  return starts;
}

TEST_F(BoardHostOnModel, MovesBackwardLinesByPartOfASlot) {
  for (const std::int64_t later : {2, -2}) {
    board_ = fpga::SynchroEvents(kRtlFifoBits);
    before_ = {};
    openings_.clear();
    ASSERT_TRUE(host_.start_lines(board_setup(), {.slots_per_microvector = 5, .backward_later_ticks = later}));
    for (std::int64_t line = 0; line < 4; ++line) {
      test::Frame frame(0, line);
      ASSERT_TRUE(host_.send(*frame));
    }
    ASSERT_TRUE(host_.finish());
    EXPECT_EQ(before_.fault, 0);
    std::vector<std::uint64_t> clocks;
    for (const Opening& opening : openings_) {
      clocks.push_back(opening.clock);
    }
    const auto moved = static_cast<std::uint64_t>(later);  // wraps for -2, and back where it is added
    const std::vector<std::uint64_t> expected{0, 121 * 4 + moved, 242 * 4, 363 * 4 + moved};
    EXPECT_EQ(line_starts(clocks, 480), expected) << "later by " << later;
  }
}

TEST_F(BoardHostOnModel, RefusesAnOffsetOfHalfASeedClock) {
  test::expect_refused(host_.start_lines(board_setup(), {.slots_per_microvector = 5, .backward_later_ticks = 3}),
                       {"the board refuses", "leaves 3 ticks", "bidirectional_offset_ticks"});
}

TEST_F(BoardHostOnModel, RunsTheAxesAlone) {
  DeviceSetup setup = board_setup();
  setup.carriage = {.prescaler = 3, .increment = 123'456'789};
  ASSERT_TRUE(host_.start_axis(setup));
  constexpr std::uint64_t kClocks = 100'000;
  ASSERT_TRUE(host_.wait(kClocks + BoardHost::kAxisLatency));
  const fpga::AbRegisters registers{32, setup.prescaler, setup.increment, setup.fraction_num, setup.fraction_den};
  EXPECT_EQ(edges_, fpga::position_after(registers, kClocks).edges);
  const fpga::AbRegisters carriage{32, 3, 123'456'789, 0, 1};
  EXPECT_EQ(carriage_edges_, fpga::position_after(carriage, kClocks).edges);
}

TEST_F(BoardHostOnModel, RefusesWhatDoesNotFitTheBoard) {
  const auto refused = [this](auto change, const char* part) {
    DeviceSetup setup = board_setup();
    change(setup);
    test::expect_refused(host_.start_lines(setup, {.slots_per_microvector = 5}), {"the board refuses", part});
  };
  refused([](DeviceSetup& setup) { setup.counter_bits = 31; }, "counter_bits = 31");
  refused([](DeviceSetup& setup) { setup.clock_multiplier = 1; }, "clock_multiplier = 1: it has 2 FPGA clocks");
  refused([](DeviceSetup& setup) { setup.clock_multiplier = 4; }, "set fpga.clock_multiplier = 2");
  refused([](DeviceSetup& setup) { setup.fraction_den = std::uint64_t{1} << 34U; }, "fraction_den = 17179869184");
  refused([](DeviceSetup& setup) { setup.increment = (1U << 30U) + 1; }, "increment = 1073741825");
  refused(
      [](DeviceSetup& setup) {
        setup.carriage = {1, 5, 1, 2};
      },
      "carriage.fraction_num = 1: allowed is 0; the second axis has no fraction");
  refused([](DeviceSetup& setup) { setup.ticks_per_slot = 3; }, "ticks_per_slot = 3: allowed is multiples");
  refused([](DeviceSetup& setup) { setup.ticks_per_slot = 131'072; }, "seeds_per_slot = 65536: allowed is 1 to 65535");
  refused([](DeviceSetup& setup) { setup.slots_per_line = 16'777'216; }, "slots_per_line = 16777216");
  refused([](DeviceSetup& setup) { setup.window_slots = setup.slots_per_line = 20'000; }, "FIFO of 4096 bytes");
  refused([](DeviceSetup& setup) { setup.slots_per_line = 20; }, "takes longer");
}

TEST(RtlBoard, SaysWhatToDoWhereItIsNotBuilt) {
  ASSERT_EQ(setenv("GRAVURE_RTL_MODULE", "/nowhere/gravure_rtl.so", 1), 0);
  const Result<RtlBoard> board = RtlBoard::load();
  ASSERT_FALSE(board);
  EXPECT_EQ(board.error().code, ErrorCode::io);
  EXPECT_NE(board.error().message.find("verilator"), std::string::npos);
  EXPECT_NE(board.error().message.find("/nowhere/gravure_rtl.so"), std::string::npos);
}

#ifdef GRAVURE_RTL_MODULE_PATH
TEST(RtlBoard, IsOneOfOurBoards) {
  ASSERT_EQ(setenv("GRAVURE_RTL_MODULE", GRAVURE_RTL_MODULE_PATH, 1), 0);
  Result<RtlBoard> board = RtlBoard::load();
  ASSERT_TRUE(board) << board.error().message;
  gravure_fpga_board_outputs out{};
  for (int clock = 0; clock < 8; ++clock) {
    out = board.value().step({});
  }
  EXPECT_EQ(out.read_data, 0x47524156U);
}
#endif

}  // namespace
}  // namespace gravure::emulator
