#include "gravure/texture/picture_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dice.hpp"
#include "published_surface.hpp"

namespace gravure::texture {
namespace {

using gravure::test::Dice;

/// A picture in memory; where `dark` ones stay dark.
class Bitmap final : public LayerLines {
 public:
  Bitmap(const PictureGrid& grid, bool dark, Dice& dice)
      : columns_(grid.columns), dark_(dark), fires_(static_cast<std::size_t>(grid.columns * grid.rows)) {
    std::generate(fires_.begin(), fires_.end(), [&dice] { return dice.coin(); });
  }
  bool fires(const Pixel& at) const { return fires_[static_cast<std::size_t>(at.row * columns_ + at.column)]; }
  Result<bool> read_lines(std::int64_t /*layer*/, std::int64_t first, std::int64_t count,
                          std::span<std::byte> out) override {
    const auto bytes = static_cast<std::size_t>((columns_ + 7) / 8);
    std::fill(out.begin(), out.end(), std::byte{0xA5});  // what lies beyond the width is undefined
    for (std::int64_t row = 0; row < count; ++row) {
      for (std::int64_t column = 0; column < columns_; ++column) {
        const std::byte bit = std::byte{0x80} >> static_cast<int>(column % 8);
        std::byte& byte = out[static_cast<std::size_t>(row) * bytes + static_cast<std::size_t>(column / 8)];
        byte = fires({first + row, column}) != dark_ ? byte | bit : byte & ~bit;
      }
    }
    return dark_;
  }

 private:
  std::int64_t columns_;
  bool dark_;
  std::vector<bool> fires_;
};

/// Where the path has run so much of its lines: straight between its points.
Vector2 at_pulse_length(const TexturePath& path, double length_mm) {
  const auto after = std::upper_bound(path.pulse_mm.begin(), path.pulse_mm.end(), length_mm);
  const auto i = static_cast<std::size_t>(after - path.pulse_mm.begin());
  const double share = (length_mm - path.pulse_mm[i - 1]) / (path.pulse_mm[i] - path.pulse_mm[i - 1]);
  return path.points_mm[i - 1] + share * (path.points_mm[i] - path.points_mm[i - 1]);
}

TEST(PicturePath, HasEveryPulseAboveTheMiddleOfItsPixel) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 60; ++trial) {
    const PictureGrid grid{.columns = dice.between(1, 40),
                           .rows = dice.between(1, 12),
                           .pixel_mm = 0.01 * static_cast<double>(dice.between(1, 9)),
                           .line_mm = 0.01 * static_cast<double>(dice.between(1, 9)),
                           .run_out_mm = dice.coin() ? 0 : 0.3,
                           .step_mm = 0.01 * static_cast<double>(dice.between(1, 30))};
    const TexturePath path = picture_path(grid, 1'000'000).value();
    Bitmap bitmap(grid, dice.coin(), dice);
    const PathPulses pulses = picture_pulses(grid, bitmap, CancelToken()).value();
    ASSERT_EQ(pulses.count, grid.columns * grid.rows);
    ASSERT_EQ(pulses.pitch_mm, grid.pixel_mm);
    for (std::int64_t i = 0; i < pulses.count; ++i) {
      const Pixel pixel = pixel_of(grid, i);
      const Vector2 stands = at_pulse_length(path, (static_cast<double>(i) + 0.5) * pulses.pitch_mm);
      ASSERT_LT((stands - pixel_mm(grid, pixel)).norm(), 1e-9) << "pulse " << i;
      const bool bit =
          (pulses.bits[static_cast<std::size_t>(i / 8)] & (std::byte{0x80} >> static_cast<int>(i % 8))) != std::byte{0};
      ASSERT_EQ(bit, bitmap.fires(pixel)) << "pulse " << i;
    }
  }
}

TEST(PicturePath, GoesInEqualStepsAndRunsOutInTheDark) {
  const PictureGrid grid{
      .columns = 10, .rows = 3, .pixel_mm = 0.1, .line_mm = 0.2, .run_out_mm = 0.25, .step_mm = 0.11};
  const TexturePath path = picture_path(grid, 1000).value();
  EXPECT_NEAR(path.step_mm, 0.1, 1e-12);
  ASSERT_EQ(path.points_mm.size(), 3U * (1 + 16) + 2);  // 3 steps of run-out at each end, 2 down
  ASSERT_EQ(path.pulse_mm.size(), path.points_mm.size());
  for (std::size_t i = 1; i < path.points_mm.size(); ++i) {
    EXPECT_NEAR((path.points_mm[i] - path.points_mm[i - 1]).norm(), path.step_mm, 1e-9) << i;
    EXPECT_GE(path.pulse_mm[i], path.pulse_mm[i - 1]);
  }
  EXPECT_LT((path.points_mm.front() - Vector2(-0.8, 0.2)).norm(), 1e-12);
  EXPECT_LT((path.points_mm[16] - Vector2(0.8, 0.2)).norm(), 1e-12);
  EXPECT_LT((path.points_mm[18] - Vector2(0.8, 0)).norm(), 1e-12);
  EXPECT_EQ(path.pulse_mm[13], path.pulse_mm[21]) << "nothing is lit on the way to the next row";
  EXPECT_NEAR(path.pulse_mm.back(), 3, 1e-12);
}

TEST(PicturePath, RefusesPicturesThatAreNoneOrTooLarge) {
  const PictureGrid good{
      .columns = 10, .rows = 3, .pixel_mm = 0.1, .line_mm = 0.2, .run_out_mm = 0.25, .step_mm = 0.11};
  PictureGrid grid = good;
  grid.columns = 0;
  EXPECT_EQ(picture_path(grid, 1000).error().code, ErrorCode::bad_argument);
  grid = good;
  grid.run_out_mm = -1;
  EXPECT_EQ(picture_path(grid, 1000).error().code, ErrorCode::bad_argument);
  grid = good;
  grid.rows = std::int64_t{1} << 31;
  EXPECT_EQ(picture_path(grid, 1000).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(picture_path(good, 50).error().code, ErrorCode::out_of_range);
}

/// Only the first pixel of each row.
class LeftRim final : public LayerLines {
 public:
  Result<bool> read_lines(std::int64_t /*layer*/, std::int64_t /*first*/, std::int64_t count,
                          std::span<std::byte> out) override {
    std::fill(out.begin(), out.end(), std::byte{0});
    for (std::int64_t row = 0; row < count; ++row) {
      out[static_cast<std::size_t>(row) * (out.size() / static_cast<std::size_t>(count))] = std::byte{0x80};
    }
    return false;
  }
};

/// 7 rows of such a width are read at once: the second lot begins with a mirrored one.
TEST(PicturePulses, GoOnToAndFroFromOneLotOfRowsToTheNext) {
  const PictureGrid grid{
      .columns = 1'190'003, .rows = 17, .pixel_mm = 0.1, .line_mm = 0.2, .run_out_mm = 0, .step_mm = 0.1};
  LeftRim rim;
  const PathPulses pulses = picture_pulses(grid, rim, CancelToken()).value();
  std::vector<std::int64_t> fired;
  for (std::int64_t i = 0; i < pulses.count; ++i) {
    if ((pulses.bits[static_cast<std::size_t>(i / 8)] & (std::byte{0x80} >> static_cast<int>(i % 8))) != std::byte{0}) {
      fired.push_back(i);
    }
  }
  ASSERT_EQ(fired.size(), 17U);
  for (std::int64_t row = 0; row < 17; ++row) {
    const Pixel pixel = pixel_of(grid, fired[static_cast<std::size_t>(row)]);
    EXPECT_EQ(pixel.row, row);
    EXPECT_EQ(pixel.column, 0) << row;
  }
}

TEST(PicturePulses, StopOnRequest) {
  Dice dice;
  const PictureGrid grid{.columns = 10, .rows = 3, .pixel_mm = 0.1, .line_mm = 0.2, .run_out_mm = 0, .step_mm = 0.1};
  Bitmap bitmap(grid, false, dice);
  CancelToken cancel;
  cancel.cancel();
  EXPECT_EQ(picture_pulses(grid, bitmap, cancel).error().code, ErrorCode::cancelled);
}

TEST(PulseLengths, AreThoseOnTheSurfaceWherePathsHaveNone) {
  const auto plane = expression_surface("0.75*x").value();
  const TexturePath path{{{0, 0}, {4, 0}, {4, 3}}, 1};
  const std::vector<double> lengths = pulse_lengths_mm(path, test::on(*plane, path.points_mm));
  ASSERT_EQ(lengths.size(), 3U);
  EXPECT_NEAR(lengths[1], 5, 1e-12);
  EXPECT_NEAR(lengths[2], 8, 1e-12);
}

}  // namespace
}  // namespace gravure::texture
