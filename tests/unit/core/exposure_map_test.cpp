#include "gravure/core/exposure_map.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "dice.hpp"

namespace gravure::test {
namespace {

/// The parts of a helical plan that the map looks at.
Plan helical_plan(const Rational& feed, std::int64_t layers, std::int64_t lines, std::int64_t columns) {
  Plan plan;
  plan.mode = Mode::helical;
  plan.rotary.lines_per_revolution = lines;
  CarriagePlan carriage;
  carriage.feed_pixels = feed;
  carriage.layers = layers;
  carriage.columns = columns;
  carriage.window_columns = static_cast<std::int64_t>(ceil_of(feed * Rational(layers)));
  carriage.revolutions = static_cast<std::int64_t>(ceil_of(Rational(columns) / feed)) + layers;
  plan.line.pixels = carriage.window_columns;
  plan.job.revolutions = carriage.revolutions;
  plan.carriage = carriage;
  return plan;
}

/// How often, and in which revolution last, a column of a line got a layer.
struct Exposed {
  int times = 0;
  std::int64_t revolution = -1;
};

/// Every column of every line gets every layer once, the first layer first, each at a pixel of the window of its own.
void expect_every_layer_once(const Plan& plan) {
  const ExposureMap map(plan);
  const CarriagePlan& carriage = *plan.carriage;
  for (std::int64_t line = 0; line < map.lines(); ++line) {
    std::vector<std::vector<Exposed>> exposed(static_cast<std::size_t>(carriage.columns),
                                              std::vector<Exposed>(static_cast<std::size_t>(carriage.layers)));
    for (std::int64_t r = 0; r < carriage.revolutions; ++r) {
      const HelicalWindow window = helical_window(plan, r, line);
      ASSERT_GE(window.fraction, 0);
      ASSERT_LT(window.fraction, 1);
      ASSERT_EQ(Rational(window.first_column) + window.fraction,
                carriage.feed_pixels * (Rational(r - carriage.layers) + ratio(line, map.lines())));
      for (std::int64_t s = 0; s < map.stretches(); ++s) {
        const Stretch stretch = map.stretch(r, line, s);
        ASSERT_GE(stretch.columns, 0);
        if (stretch.columns == 0) {
          continue;
        }
        ASSERT_GE(stretch.first_pixel, 0);
        ASSERT_LE(stretch.first_pixel + stretch.columns, plan.line.pixels);
        ASSERT_EQ(stretch.first_pixel, stretch.first_column - window.first_column) << "a pixel moves off its column";
        for (std::int64_t c = stretch.first_column; c < stretch.first_column + stretch.columns; ++c) {
          Exposed& pixel = exposed.at(static_cast<std::size_t>(c)).at(static_cast<std::size_t>(stretch.layer));
          ++pixel.times;
          pixel.revolution = r;
        }
      }
    }
    for (std::int64_t c = 0; c < carriage.columns; ++c) {
      for (std::int64_t layer = 0; layer < carriage.layers; ++layer) {
        const auto& column = exposed[static_cast<std::size_t>(c)];
        const Exposed& pixel = column[static_cast<std::size_t>(layer)];
        ASSERT_EQ(pixel.times, 1) << "line " << line << ", column " << c << ", layer " << layer;
        if (layer > 0) {
          ASSERT_EQ(pixel.revolution, column[static_cast<std::size_t>(layer - 1)].revolution + 1);
        }
      }
    }
  }
}

TEST(ExposureMap, GivesEveryColumnEveryLayerOnceWhateverTheFeed) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 400; ++trial) {
    const std::int64_t den = dice.between(1, 12);
    const Rational feed = ratio(dice.between(1, 9 * den), den);
    const Plan plan = helical_plan(feed, dice.between(1, 5), dice.between(1, 14), dice.between(1, 40));
    SCOPED_TRACE(testing::Message() << "feed " << to_string(feed) << ", " << plan.carriage->layers << " layers, "
                                    << plan.rotary.lines_per_revolution << " lines, " << plan.carriage->columns
                                    << " columns");
    expect_every_layer_once(plan);
    if (HasFatalFailure()) {
      return;
    }
  }
}

TEST(ExposureMap, TakesTheSameColumnsWhereProductsExceed64Bits) {
  const std::int64_t lines = 1'000'003;
  const Rational feed = ratio(100'000'000'007, 3'125'000'001);  // a little below 32
  const Plan plan = helical_plan(feed, 3, lines, 1'000'000);
  ASSERT_TRUE(ExposureMap::fits(feed, lines));
  const ExposureMap map(plan);
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 2000; ++trial) {
    const std::int64_t steps = dice.between(-3 * lines, plan.carriage->revolutions * lines);
    ASSERT_EQ(Integer(map.column_after(steps)), floor_of(feed * ratio(steps, lines))) << steps;
  }
  EXPECT_FALSE(ExposureMap::fits(ratio(Integer(1) << 63, 3), 1));
}

TEST(ExposureMap, ButtsBandsToThePixel) {
  Plan plan;
  plan.mode = Mode::rotary;
  plan.rotary.lines_per_revolution = 5;
  plan.line.pixels = 4;
  plan.bands = BandsPlan{3, 11, 2};
  plan.job.revolutions = 6;
  const ExposureMap map(plan);
  EXPECT_FALSE(map.whole_images());
  std::map<std::int64_t, int> times;
  for (std::int64_t r = 0; r < 6; ++r) {
    const Stretch stretch = map.stretch(r, 3, 0);
    EXPECT_EQ(stretch.first_pixel, 0);
    EXPECT_EQ(map.image_line(r, 3), 3);
    for (std::int64_t c = 0; c < stretch.columns; ++c) {
      ++times[stretch.first_column + c];
    }
  }
  EXPECT_EQ(times.size(), 11U);
  for (const auto& [column, count] : times) {
    EXPECT_EQ(count, 2) << column;
    EXPECT_LT(column, 11);
  }
}

TEST(ExposureMap, RunsEveryOtherPassOfTheStageBackwards) {
  Plan plan;
  plan.mode = Mode::flat;
  plan.rotary.lines_per_revolution = 7;
  plan.line.pixels = 3;
  plan.job.revolutions = 3;
  const ExposureMap map(plan);
  EXPECT_FALSE(map.whole_images());
  EXPECT_EQ(map.image_line(0, 2), 2);
  EXPECT_EQ(map.image_line(1, 2), 4);
  EXPECT_EQ(map.image_line(2, 2), 2);
  plan.mode = Mode::rotary;
  EXPECT_TRUE(ExposureMap(plan).whole_images());
}

}  // namespace
}  // namespace gravure::test
