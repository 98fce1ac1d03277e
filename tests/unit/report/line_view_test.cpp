#include "gravure/report/line_view.hpp"

#include "dice.hpp"
#include "gravure/fpga/ab_counter.hpp"
#include "report_support.hpp"

namespace gravure::report {
namespace {

using gravure::test::Dice;
using gravure::test::image_pixel;
using test::prepare;
using test::SmallJob;

int state_of(const fpga::AbPins& pins) {
  return 2 * static_cast<int>(pins.a) + static_cast<int>(pins.b);
}

TEST(EdgesIn, AreWhereTheModelOfTheCounterPutsThem) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 100; ++trial) {
    AbPlan ab;
    ab.counter_bits = static_cast<int>(dice.between(8, 16));
    ab.prescaler = static_cast<std::uint64_t>(dice.between(1, 5));
    ab.fraction_den = static_cast<std::uint64_t>(trial % 2 == 0 ? 1 : dice.between(2, 50));
    ab.fraction_num = trial % 2 == 0 ? 0 : static_cast<std::uint64_t>(dice.word() % ab.fraction_den);
    const std::int64_t most = (std::int64_t{1} << (ab.counter_bits - 2)) - 1;
    ab.increment = static_cast<std::uint64_t>(trial < 2 ? most : dice.between(1, most));
    const std::int64_t begin = dice.between(0, 3000);
    const EdgesIn edges = edges_in(ab, std::nullopt, begin, begin + 2000, 1'000'000);
    std::optional<fpga::AbCounter> counter =
        fpga::AbCounter::make({ab.counter_bits, ab.prescaler, ab.increment, ab.fraction_num, ab.fraction_den});
    ASSERT_TRUE(counter);
    std::vector<std::int64_t> wanted;
    Integer before = 0;
    int state = 0;
    for (std::int64_t clock = 1; clock <= begin + 2000; ++clock) {
      const int now = state_of(counter->step());
      if (now != state && clock <= begin) {
        ++before;
      } else if (now != state) {
        wanted.push_back(clock);
      }
      state = now;
    }
    ASSERT_EQ(edges.ticks, wanted) << "trial " << trial;
    ASSERT_EQ(edges.before, before);
    ASSERT_FALSE(edges.cut);
  }
}

TEST(EdgesIn, SayWhereTheyStop) {
  AbPlan ab;
  ab.counter_bits = 8;
  ab.increment = 64;  // an edge every clock
  const EdgesIn edges = edges_in(ab, std::nullopt, 0, 100, 10);
  EXPECT_EQ(edges.ticks.size(), 10U);
  EXPECT_TRUE(edges.cut);
}

TEST(LineView, OpensTheGateForThePixelsOfTheImageInTimeOrder) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::white, 4, 13);  // odd lines: directions change from revolution to revolution
  gravure::test::MemorySource program(small.program);
  const Plan& plan = small.program.header.plan;
  for (const std::int64_t revolution : {0, 1, 3}) {
    for (const std::int64_t line : {0, 1, 12}) {
      const Result<LineView> view = line_view(program, revolution, line);
      ASSERT_TRUE(view) << view.error().message;
      std::vector<bool> open(static_cast<std::size_t>(plan.line.slots));
      for (const GateRun& run : view.value().gate) {
        for (std::int64_t slot = run.first_slot; slot < run.first_slot + run.slots; ++slot) {
          open[static_cast<std::size_t>(slot)] = true;
        }
      }
      EXPECT_EQ(view.value().reverse, line_is_reverse(plan, revolution, line));
      std::int64_t fired = 0;
      for (std::int64_t column = 0; column < 45; ++column) {
        const bool wanted = image_pixel(small.stack, small.images, revolution % 3, line, column);
        const std::int64_t slot =
            view.value().reverse ? plan.line.reverse_first_slot + 44 - column : plan.line.forward_first_slot + column;
        EXPECT_EQ(open[static_cast<std::size_t>(slot)], wanted);
        fired += wanted ? 1 : 0;
      }
      EXPECT_EQ(view.value().fired, fired);
      EXPECT_FALSE(view.value().no_mirrors.empty());  // this job does not describe its scanner
    }
  }
}

TEST(LineView, BeginsWithThePinsWhereTheLinesBeforeHaveLeftThem) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::white, 4, 13);
  gravure::test::MemorySource program(small.program);
  const AbPlan& ab = small.program.header.plan.ab;
  std::optional<fpga::AbCounter> counter =
      fpga::AbCounter::make({ab.counter_bits, ab.prescaler, ab.increment, ab.fraction_num, ab.fraction_den});
  ASSERT_TRUE(counter);
  int state = 0;
  for (std::int64_t line = 0; line < 13; ++line) {
    const Result<LineView> view = line_view(program, 0, line);
    ASSERT_TRUE(view) << view.error().message;
    EXPECT_EQ(view.value().ab_state_at_start, state);
    std::vector<std::int64_t> wanted;
    for (std::int64_t tick = 1; tick <= small.program.header.plan.line.ticks; ++tick) {
      const int now = state_of(counter->step());
      if (now != state) {
        wanted.push_back(tick);
      }
      state = now;
    }
    EXPECT_EQ(view.value().edge_ticks, wanted);
  }
}

TEST(LineView, IsFirstOfALineThatFires) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::white, 3);
  for (auto& [address, chunk] : small.program.chunks) {
    if (address.first == 0 && address.second < 2) {  // lines 0 to 7
      std::fill(chunk.bytes.begin(), chunk.bytes.end(), std::byte{0});
    }
  }
  gravure::test::MemorySource program(small.program);
  EXPECT_EQ(first_firing_line(program, 0, 0).value(), 8);
  EXPECT_EQ(first_firing_line(program, 1, 0).value(), 0);
}

}  // namespace
}  // namespace gravure::report
