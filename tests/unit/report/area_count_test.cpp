#include "gravure/report/area_count.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "dice.hpp"

namespace gravure::report {
namespace {

using test::Dice;

bool bit(const std::vector<std::byte>& bits, std::int64_t row_bytes, std::int64_t x, std::int64_t y) {
  const auto byte = static_cast<unsigned>(bits[static_cast<std::size_t>(y * row_bytes + x / 8)]);
  return ((byte >> (7 - x % 8)) & 1U) != 0;
}

TEST(AreaCount, CountsEveryPixelOnceInTheCellItLiesIn) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 200; ++trial) {
    const Extent picture{dice.between(1, 300), dice.between(1, 40)};
    const Extent cells{dice.between(1, trial % 3 == 0 ? picture.width : std::min<std::int64_t>(picture.width, 5)),
                       dice.between(1, picture.height)};
    const std::int64_t row_bytes = (picture.width + 7) / 8;
    std::vector<std::byte> bits(static_cast<std::size_t>(row_bytes * picture.height));
    for (std::byte& byte : bits) {
      byte = static_cast<std::byte>(dice.word() & 0xFFU);
    }
    std::vector<std::int64_t> counted;
    AreaCount count(picture, cells, [&](std::int64_t row, std::span<const std::int64_t> some) {
      EXPECT_EQ(static_cast<std::int64_t>(counted.size()), row * cells.width);
      counted.insert(counted.end(), some.begin(), some.end());
    });
    for (std::int64_t row = 0; row < picture.height;) {  // rows come a few at a time
      const std::int64_t some = std::min(picture.height - row, dice.between(1, 7));
      ASSERT_TRUE(count.add(std::span(bits).subspan(static_cast<std::size_t>(row * row_bytes),
                                                    static_cast<std::size_t>(some * row_bytes)),
                            some));
      row += some;
    }
    ASSERT_TRUE(count.complete());
    std::vector<std::int64_t> ones(static_cast<std::size_t>(cells.area()));
    std::vector<std::int64_t> pixels(ones.size());
    for (std::int64_t y = 0; y < picture.height; ++y) {
      for (std::int64_t x = 0; x < picture.width; ++x) {
        // The cell whose begin is at or before the pixel and whose end is behind it, sought without a formula.
        std::int64_t column = 0;
        while ((column + 1) * picture.width / cells.width <= x) {
          ++column;
        }
        std::int64_t row = 0;
        while ((row + 1) * picture.height / cells.height <= y) {
          ++row;
        }
        const auto cell = static_cast<std::size_t>(row * cells.width + column);
        ones[cell] += bit(bits, row_bytes, x, y) ? 1 : 0;
        ++pixels[cell];
      }
    }
    ASSERT_EQ(counted, ones);
    const std::vector<std::int64_t> widths = cell_sizes(cells.width, picture.width);
    const std::vector<std::int64_t> heights = cell_sizes(cells.height, picture.height);
    for (std::int64_t cell = 0; cell < cells.area(); ++cell) {
      ASSERT_EQ(
          widths[static_cast<std::size_t>(cell % cells.width)] * heights[static_cast<std::size_t>(cell / cells.width)],
          pixels[static_cast<std::size_t>(cell)]);
    }
  }
}

TEST(AreaCount, RefusesRowsBeyondThePicture) {
  AreaCount count({10, 2}, {5, 1}, [](std::int64_t, std::span<const std::int64_t>) {});
  const std::vector<std::byte> rows(6);
  EXPECT_EQ(count.add(rows, 3).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(count.add(rows, 1).error().code, ErrorCode::bad_argument);
  EXPECT_TRUE(count.add(std::span(rows).first(4), 2));
  EXPECT_FALSE(count.add(std::span(rows).first(2), 1));
}

TEST(ChooseCells, ShowsEveryPixelOfASmallPicture) {
  const Extent cells = choose_cells({300, 200}, 8, 2, 60'000);
  EXPECT_EQ(cells.width, 300);
  EXPECT_EQ(cells.height, 200);
}

TEST(ChooseCells, StaysWithinItsNumberAndThePicture) {
  for (const Extent& picture : {Extent{195'000, 190'000}, Extent{1'000'000'000, 1}, Extent{1, 1'000'000'000},
                                Extent{3'000'000, 12}, Extent{501, 501}}) {
    for (const std::int64_t most : {1, 7, 250'000}) {
      const Extent cells = choose_cells(picture, 8, 2, most);
      EXPECT_LE(cells.area(), most);
      EXPECT_TRUE(cells.width >= 1 && cells.height >= 1);
      EXPECT_TRUE(cells.width <= picture.width && cells.height <= picture.height);
    }
  }
}

TEST(ChooseCells, MakesCellsThatAreSquareOnTheWorkpiece) {
  const Extent cells = choose_cells({100'000, 100'000}, 8, 2, 250'000);  // four times as wide as high
  const double width = 8.0 * 100'000 / static_cast<double>(cells.width);
  const double height = 2.0 * 100'000 / static_cast<double>(cells.height);
  EXPECT_NEAR(width / height, 1, 0.01);
}

TEST(AreaCount, CountsALayerOf37GigapixelsInTheCellsOfAPage) {
  const Extent picture{188'500, 196'300};
  const Extent cells = choose_cells(picture, 8, 8, 250'000);
  ASSERT_LE(cells.area(), 250'000) << "what is kept does not grow with the picture";
  constexpr std::int64_t kRows = 100;  // the same ones again and again: every eighth pixel of every other row
  const std::int64_t row_bytes = (picture.width + 7) / 8;
  std::vector<std::byte> rows(static_cast<std::size_t>(kRows * row_bytes));
  for (std::int64_t row = 0; row < kRows; row += 2) {
    std::fill_n(rows.begin() + row * row_bytes, row_bytes - 1, std::byte{0x80});
    rows[static_cast<std::size_t>((row + 1) * row_bytes - 1)] = std::byte{0x80};  // 4 pixels are left in it
  }
  std::vector<std::int64_t> counted;
  AreaCount count(picture, cells, [&](std::int64_t, std::span<const std::int64_t> some) {
    counted.insert(counted.end(), some.begin(), some.end());
  });
  for (std::int64_t row = 0; row < picture.height; row += kRows) {
    ASSERT_TRUE(count.add(rows, kRows));
  }
  ASSERT_TRUE(count.complete());
  const std::vector<std::int64_t> widths = cell_sizes(cells.width, picture.width);
  const std::vector<std::int64_t> heights = cell_sizes(cells.height, picture.height);
  std::int64_t ones = 0;
  std::int64_t pixels = 0;
  for (std::int64_t row = 0; row < cells.height; ++row) {
    for (std::int64_t column = 0; column < cells.width; ++column) {
      const std::int64_t in_cell = widths[static_cast<std::size_t>(column)] * heights[static_cast<std::size_t>(row)];
      const std::int64_t fired = counted[static_cast<std::size_t>(row * cells.width + column)];
      ones += fired;
      pixels += in_cell;
      ASSERT_NEAR(static_cast<double>(fired) / static_cast<double>(in_cell), 1.0 / 16, 0.002) << column << ", " << row;
    }
  }
  EXPECT_EQ(pixels, picture.area());
  EXPECT_EQ(ones, row_bytes * picture.height / 2);
}

TEST(CellBegin, DoesNotOverflowWhereThePictureIsLarge) {
  EXPECT_EQ(cell_begin(250'000, 250'000, std::int64_t{1} << 60), std::int64_t{1} << 60);
  EXPECT_EQ(cell_begin(1, 3, 10), 3);
  EXPECT_EQ(cell_begin(2, 3, 10), 6);
}

}  // namespace
}  // namespace gravure::report
