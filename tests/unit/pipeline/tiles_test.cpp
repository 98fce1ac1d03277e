#include "gravure/pipeline/tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "dice.hpp"
#include "gravure/core/units.hpp"
#include "naive_compile.hpp"

namespace gravure::test {
namespace {

ImageInfo tile_info(SampleType samples, std::int64_t width, std::int64_t height, bool random_access = true) {
  ImageInfo info;
  info.path = "tile";
  info.width = width;
  info.height = height;
  info.samples = samples;
  info.random_access = random_access;
  return info;
}

/// Sample `column` of a row as read_rows() gives it.
double sample_of(SampleType samples, std::span<const std::byte> row, std::int64_t column) {
  const auto at = static_cast<std::size_t>(column);
  if (samples == SampleType::bit) {
    return static_cast<double>((std::to_integer<unsigned>(row[at / 8]) >> (7 - at % 8)) & 1U);
  }
  if (samples == SampleType::u8) {
    return std::to_integer<int>(row[at]);
  }
  if (samples == SampleType::u16) {
    std::uint16_t value = 0;
    std::memcpy(&value, row.data() + 2 * at, 2);
    return value;
  }
  float value = 0;
  std::memcpy(&value, row.data() + 4 * at, 4);
  return static_cast<double>(value);
}

TEST(Tiles, LieSideBySideSampleForSampleWhateverRowsAreAskedFor) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 400; ++trial) {
    const auto type = static_cast<SampleType>(trial % 4);
    const TileGrid grid{dice.between(1, 5), dice.between(1, 5), dice.coin(), dice.coin()};
    const ImageInfo tile = tile_info(type, dice.between(1, 70), dice.between(1, 9), dice.coin());
    MemoryImages images;
    const Samples samples = random_samples(type, static_cast<std::uint64_t>(trial) + Dice::seed());
    images.add({tile, samples, {}, {}});
    const auto opened = open_tiled(images, "tile", 0, grid);
    ASSERT_TRUE(opened);
    ImageSource& source = *opened.value();
    ASSERT_EQ(source.info().width, tile.width * grid.across);
    ASSERT_EQ(source.info().height, tile.height * grid.down);
    const std::int64_t bytes = row_bytes(type, source.info().width);
    for (int part = 0; part < 6; ++part) {
      const std::int64_t first = dice.between(0, source.info().height - 1);
      const std::int64_t count = dice.between(1, source.info().height - first);
      std::vector<std::byte> rows(static_cast<std::size_t>(count * bytes));
      if (!grid.repeats() && !tile.random_access) {
        continue;  // a file as it is, which its reader opens again
      }
      ASSERT_TRUE(source.read_rows(first, count, rows));
      for (std::int64_t y = 0; y < count; ++y) {
        const auto row = std::span<const std::byte>(rows).subspan(static_cast<std::size_t>(y * bytes));
        for (std::int64_t x = 0; x < source.info().width; ++x) {
          ASSERT_EQ(sample_of(type, row, x), samples(in_tile(first + y, tile.height, grid.mirror_down),
                                                     in_tile(x, tile.width, grid.mirror_across)))
              << "trial " << trial << ", row " << first + y << ", column " << x;
        }
      }
    }
  }
}

TEST(Tiles, AreTurnedOverInTurnFromTheSecondOn) {
  MemoryImages images;
  images.add({tile_info(SampleType::u8, 2, 2),
              [](std::int64_t row, std::int64_t column) { return static_cast<double>(1 + 2 * row + column); },
              {},
              {}});
  const auto opened = open_tiled(images, "tile", 0, {3, 2, true, true});
  ASSERT_TRUE(opened);
  std::vector<std::byte> rows(24);
  ASSERT_TRUE(opened.value()->read_rows(0, 4, rows));
  const int expected[] = {1, 2, 2, 1, 1, 2, 3, 4, 4, 3, 3, 4, 3, 4, 4, 3, 3, 4, 1, 2, 2, 1, 1, 2};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(std::to_integer<int>(rows[i]), expected[i]) << i;
  }
}

TEST(Tiles, RoundTheWorkpieceAreDownTheRowsOrAcrossThem) {
  const RepeatSettings repeat{2, 3, true, false};
  const TileGrid rows = tile_grid(repeat, LinesAlong::rows);
  EXPECT_EQ(rows.down, 2);
  EXPECT_EQ(rows.across, 3);
  EXPECT_TRUE(rows.mirror_down);
  EXPECT_FALSE(rows.mirror_across);
  const TileGrid columns = tile_grid(repeat, LinesAlong::columns);
  EXPECT_EQ(columns.across, 2);
  EXPECT_EQ(columns.down, 3);
  EXPECT_TRUE(columns.mirror_across);
  EXPECT_FALSE(columns.mirror_down);
}

TEST(Tiles, PassOnThatATileIsDamagedAndReadOn) {
  MemoryImages images;
  images.add({tile_info(SampleType::bit, 9, 4), random_samples(SampleType::bit, 1), 2, {}});
  const auto opened = open_tiled(images, "tile", 0, {2, 3, false, true});
  ASSERT_TRUE(opened);
  std::vector<std::byte> rows(3);
  EXPECT_TRUE(opened.value()->read_rows(0, 1, rows));
  const Result<void> damaged = opened.value()->read_rows(5, 1, rows);  // row 2 of the tile that is turned over
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().code, ErrorCode::bad_file);
  EXPECT_TRUE(opened.value()->read_rows(4, 1, rows));
}

TEST(Tiles, HoldSomeRowsOfTheTileHoweverLargeThePicture) {
  const TileGrid many{1000, 1000, true, true};
  EXPECT_EQ(tiled_info(tile_info(SampleType::bit, 80'000, 50'000), many).decoder_bytes, kMiB / 10'000 * 10'000);
  EXPECT_EQ(tiled_info(tile_info(SampleType::u16, 4 * kMiB, 3), many).decoder_bytes, 8 * kMiB) << "a row at least";
  EXPECT_EQ(tiled_info(tile_info(SampleType::u8, 10, 3), many).decoder_bytes, 30);
  EXPECT_EQ(tiled_info(tile_info(SampleType::u8, 10, 3), {}).decoder_bytes, 0) << "as the file has it";
}

TEST(Tiles, CompileToThePulsesOfThePictureTheyMakeInLittleMemory) {
  MemoryImages images;
  LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::rows, 50, 3000, 2, 5);
  stack.tiles = {40, 20, true, true};  // 120,000 x 1000 pixels: 15 MB
  stack.lines *= 20;
  stack.pixels *= 40;
  const ProgramHeader header = header_for(stack, true);
  const std::int64_t least = least_compile_memory(stack, 10) + kMiB;
  ASSERT_LT(least, 10 * kMiB);
  MemoryProgram program;
  program.lines_per_chunk = 10;
  MemorySink sink(program);
  ASSERT_TRUE(compile(header, stack, images, sink, {.memory_bytes = least, .threads = 1}));
  for (const std::int64_t line : {0, 1, 49, 50, 99, 100, 777, 999}) {
    ASSERT_EQ(program.line(1, line), naive_line(header, stack, images, 1, line)) << line;
  }
}

}  // namespace
}  // namespace gravure::test
