#include "gravure/report/path_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "dice.hpp"

namespace gravure::report {
namespace {

/// Set-points of a sine on X and nothing on the other axes, made while they are read.
class WavySource final : public LineSource {
 public:
  explicit WavySource(std::int64_t periods) {
    header_.plan.mode = Mode::freeform;
    header_.plan.rotary.lines_per_revolution = periods;
    header_.plan.path.emplace();
    for (PathAxisPlan& axis : header_.plan.path->axes) {
      axis.counts_per_unit = 1000;
    }
  }
  const ProgramHeader& header() const noexcept override { return header_; }
  std::int64_t lines_per_chunk() const noexcept override { return 1; }
  Result<StoredChunk> fetch(ChunkAddress) override { return Error{ErrorCode::bad_argument, "not needed here"}; }
  Result<void> decode(const StoredChunk&, std::span<std::byte>) const override { return {}; }
  Result<void> read_set_points(std::int64_t first, std::span<PathSetPoint> out) override {
    most_asked_ = std::max(most_asked_, out.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = {};
      out[i].counts[0] = x_at(first + static_cast<std::int64_t>(i));
      out[i].counts[3] = 1000;  // 1 rad
    }
    return {};
  }
  static std::int64_t x_at(std::int64_t i) { return std::llround(50'000 * std::sin(static_cast<double>(i) / 37)); }
  std::size_t most_asked() const { return most_asked_; }

 private:
  ProgramHeader header_;
  std::size_t most_asked_ = 0;
};

TEST(PathTraces, BandHoldsEverySetPointAndReadsInBlocks) {
  constexpr std::int64_t kPeriods = 100'000;
  WavySource program(kPeriods);
  const Result<PathTraces> traces = path_traces(program, 600);
  ASSERT_TRUE(traces) << traces.error().message;
  const AxisTrace& x = traces.value()[0];
  ASSERT_EQ(x.least.size(), 600U);
  ASSERT_EQ(x.most.size(), 600U);
  for (std::int64_t i = 0; i <= kPeriods; ++i) {
    const auto stretch = static_cast<std::size_t>(i * 600 / (kPeriods + 1));
    const double at = static_cast<double>(WavySource::x_at(i)) / 1000;
    ASSERT_LE(x.least[stretch], at) << i;
    ASSERT_GE(x.most[stretch], at) << i;
  }
  for (std::size_t i = 1; i < x.least.size(); ++i) {  // what is drawn has no gaps
    ASSERT_LE(x.least[i], x.most[i - 1]) << i;
    ASSERT_GE(x.most[i], x.least[i - 1]) << i;
  }
  EXPECT_NEAR(traces.value()[3].most[5], 180 / 3.14159265358979323846, 1e-12) << "A is told in degrees";
  EXPECT_LE(program.most_asked(), 8192U) << "memory does not grow with the program";
}

TEST(PathTraces, HasAStretchForEachOfFewSetPoints) {
  WavySource program(4);
  const Result<PathTraces> traces = path_traces(program, 600);
  ASSERT_TRUE(traces) << traces.error().message;
  EXPECT_EQ(traces.value()[0].least.size(), 5U);
}

TEST(PulseMap, KeepsEveryPulseWhereItLandedHoweverFarTheyReach) {
  SCOPED_TRACE(gravure::test::Dice::note());
  gravure::test::Dice dice;
  const auto share = [&dice] { return static_cast<double>(dice.between(0, 1000)) / 1000; };
  PulseMap map;
  constexpr std::int64_t kPulses = 20'000;
  double least_x = 1e9;
  for (std::int64_t i = 0; i < kPulses; ++i) {  // further and further out, on both sides of 0
    const double reach = static_cast<double>(i) / 100;
    const double x = reach * (share() - 0.4);
    const double y = reach * (share() - 0.7);
    least_x = std::min(least_x, x);
    map.take(x, y, x >= 0 ? 2 : 1);
  }
  const Extent cells = map.cells();
  EXPECT_LE(cells.width, PulseMap::kSide);
  EXPECT_LE(cells.height, PulseMap::kSide);
  EXPECT_GT(std::max(cells.width, cells.height), PulseMap::kSide / 2 - 2) << "no coarser than it must be";
  const std::vector<double> pulses = map.pulses();
  const std::vector<double> heights = map.heights();
  ASSERT_EQ(pulses.size(), static_cast<std::size_t>(cells.area()));
  EXPECT_EQ(std::accumulate(pulses.begin(), pulses.end(), 0.0), static_cast<double>(kPulses));
  EXPECT_LE(map.left_mm(), least_x);
  EXPECT_GT(map.left_mm() + map.cell_mm(), least_x);
  for (std::int64_t row = 0; row < cells.height; ++row) {
    for (std::int64_t column = 0; column < cells.width; ++column) {
      const auto i = static_cast<std::size_t>(row * cells.width + column);
      const double left = map.left_mm() + static_cast<double>(column) * map.cell_mm();
      if (pulses[i] > 0) {  // right of 0 the surface is 2 high, left of it 1
        ASSERT_NEAR(heights[i], left >= 0 ? 2 : 1, 1e-12) << column << ", " << row;
      }
    }
  }
  EXPECT_EQ(map.lowest_mm(), 1);
  EXPECT_EQ(map.highest_mm(), 2);
}

/// The outermost cells of odd and even numbers on both sides of 0, and nothing further out afterwards.
TEST(PulseMap, KeepsItsOutermostCellsWhenTheyGetWider) {
  constexpr double kCell_mm = 1.0 / 1024;
  for (const std::int64_t low : {-4, -3, -1, 0, 5}) {
    for (const bool along_x : {true, false}) {
      const auto at = [](std::int64_t cell) { return (static_cast<double>(cell) + 0.5) * kCell_mm; };
      PulseMap map;
      for (const std::int64_t cell : {low, low + PulseMap::kSide + 1}) {
        map.take(along_x ? at(cell) : 0, along_x ? 0 : at(cell), 1);
      }
      EXPECT_EQ(map.cell_mm(), 2 * kCell_mm);
      const std::vector<double> pulses = map.pulses();
      EXPECT_EQ(std::accumulate(pulses.begin(), pulses.end(), 0.0), 2) << low;
      EXPECT_EQ(pulses.front(), 1) << low;
      EXPECT_EQ(pulses.back(), 1) << low;
      EXPECT_LE(along_x ? map.left_mm() : map.bottom_mm(), at(low)) << low;
    }
  }
}

TEST(PulseSample, KeepsEveryNthPulseAndNeverMoreThanItsMost) {
  PulseSample sample;
  std::int64_t taken = 0;
  const auto take_to = [&](std::int64_t count) {
    for (; taken < count; ++taken) {
      sample.take({static_cast<double>(taken), 0, -1});
    }
  };
  constexpr auto kMost = static_cast<std::int64_t>(PulseSample::kMost);
  for (const auto& [count, every] : {std::pair<std::int64_t, std::int64_t>{1, 1},
                                     {kMost, 1},
                                     {kMost + 1, 2},
                                     {2 * kMost, 2},
                                     {2 * kMost + 1, 4},
                                     {1'000'000, 64}}) {
    take_to(count);
    SCOPED_TRACE(count);
    EXPECT_EQ(sample.every(), every);
    ASSERT_EQ(static_cast<std::int64_t>(sample.places_mm().size()), (count + every - 1) / every);
    for (std::size_t i = 0; i < sample.places_mm().size(); ++i) {
      ASSERT_EQ(sample.places_mm()[i][0], static_cast<double>(static_cast<std::int64_t>(i) * every)) << i;
    }
  }
}

TEST(PulseSample, LeavesOutWhatIsNoPlace) {
  PulseSample sample;
  sample.take({0, std::numeric_limits<double>::infinity(), 0});
  sample.take({1, 2, 3});
  EXPECT_EQ(sample.places_mm(), (std::vector<std::array<double, 3>>{{1, 2, 3}}));
}

TEST(PulseMap, IsLookedAtWithYUpwards) {
  PulseMap map;
  map.take(0.0001, 0.0001, 0);
  map.take(0.0001, 0.0021, 0);  // two cells of 1/1024 mm further up
  map.take(0.0001, 0.0021, 0);
  ASSERT_EQ(map.cells().width, 1);
  ASSERT_EQ(map.cells().height, 3);
  EXPECT_EQ(map.pulses(), (std::vector<double>{2, 0, 1}));
}

}  // namespace
}  // namespace gravure::report
