#include "gravure/raster/place.hpp"

#include "raster_support.hpp"

namespace gravure::raster {
namespace {

/// Bit by bit, from the words of place.hpp.
void place_bits(Bytes& dst, std::int64_t dst_bit, const Bytes& src, std::int64_t src_bit, std::int64_t width,
                PlaceOptions options) {
  for (std::int64_t k = 0; k < width; ++k) {
    set_bit(dst, dst_bit + k, get_bit(src, src_bit + (options.mirror ? width - 1 - k : k)) != options.invert);
  }
}

Bytes rows_bit_by_bit(const Bytes& src, std::int64_t width, std::int64_t rows, RowOptions options) {
  const std::int64_t stride = packed_bytes(width);
  Bytes dst(static_cast<std::size_t>(rows * stride));
  for (std::int64_t row = 0; row < rows; ++row) {
    const bool mirror = options.first_mirrored != (options.alternate && row % 2 == 1);
    for (std::int64_t k = 0; k < width; ++k) {
      const std::int64_t from = mirror ? width - 1 - k : k;
      set_bit(dst, 8 * row * stride + k, get_bit(src, 8 * row * stride + from) != options.invert);
    }
  }
  return dst;
}

class PlaceLine : public KernelTest {};
class PlaceRows : public KernelTest {};
INSTANTIATE_TEST_SUITE_P(Raster, PlaceLine, kEveryIsa, kIsaName);
INSTANTIATE_TEST_SUITE_P(Raster, PlaceRows, kEveryIsa, kIsaName);

TEST_P(PlaceLine, EqualsBitByBitAndKeepsAllOtherBits) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  for (int trial = 0; trial < 20000; ++trial) {
    const std::int64_t width = dice.size(3000);
    const std::int64_t dst_bit = dice.up_to(70);
    const std::int64_t src_bit = dice.coin() ? 0 : dice.up_to(70);
    const PlaceOptions options{.mirror = dice.coin(), .invert = dice.coin()};
    const Bytes src =
        dice.bytes(packed_bytes(src_bit + width));  // no slack: the address sanitizer sees a byte too many
    Bytes dst = dice.bytes(packed_bytes(dst_bit + width) + (dice.coin() ? dice.up_to(40) : 0));
    Bytes expected = dst;
    place_bits(expected, dst_bit, src, src_bit, width, options);
    kernels().place_line(dst, dst_bit, src, src_bit, width, options);
    ASSERT_EQ(dst, expected) << "width " << width << " from bit " << src_bit << " to bit " << dst_bit << ", mirror "
                             << options.mirror << ", invert " << options.invert;
  }
}

TEST_P(PlaceLine, EqualsPortableOnWideLines) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  for (int trial = 0; trial < 500; ++trial) {
    const std::int64_t width = dice.up_to(200000);
    const std::int64_t dst_bit = dice.up_to(1000);
    const std::int64_t src_bit = dice.coin() ? 0 : dice.up_to(1000);
    const PlaceOptions options{.mirror = dice.coin(), .invert = dice.coin()};
    const Bytes src = dice.bytes(packed_bytes(src_bit + width));
    Bytes dst = dice.bytes(packed_bytes(dst_bit + width));
    Bytes expected = dst;
    portable().place_line(expected, dst_bit, src, src_bit, width, options);
    kernels().place_line(dst, dst_bit, src, src_bit, width, options);
    ASSERT_EQ(dst, expected) << "width " << width << " from bit " << src_bit << " to bit " << dst_bit << ", mirror "
                             << options.mirror << ", invert " << options.invert;
  }
}

/// What a helical line is put together of: neighbours that share bytes, each from a place of its own.
TEST_P(PlaceLine, LaysStretchesSideBySide) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  for (int trial = 0; trial < 500; ++trial) {
    const std::int64_t most = dice.coin() ? 20 : 900;
    const Bytes src = dice.bytes(packed_bytes(4000));
    Bytes dst = dice.bytes(packed_bytes(4000));
    Bytes expected = dst;
    for (std::int64_t at = dice.up_to(20); at < 4000;) {
      const std::int64_t width = std::min<std::int64_t>(dice.up_to(most), 4000 - at);
      const std::int64_t from = dice.up_to(4000 - width);
      const bool invert = dice.coin();
      place_bits(expected, at, src, from, width, {.invert = invert});
      kernels().place_line(dst, at, src, from, width, {.invert = invert});
      at += width + dice.up_to(3);
    }
    ASSERT_EQ(dst, expected) << "stretches of up to " << most;
  }
}

TEST_P(PlaceRows, EqualsBitByBitAndZeroesUnusedBits) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  for (int trial = 0; trial < 20000; ++trial) {
    const std::int64_t width = dice.size(3000);
    const std::int64_t rows = dice.up_to(width > 1000 ? 3 : 6);
    const RowOptions options{.invert = dice.coin(), .first_mirrored = dice.coin(), .alternate = dice.coin()};
    const Bytes src = dice.bytes(rows * packed_bytes(width));
    Bytes dst = dice.bytes(rows * packed_bytes(width));
    kernels().place_rows(dst, src, width, rows, options);
    ASSERT_EQ(dst, rows_bit_by_bit(src, width, rows, options))
        << "width " << width << ", rows " << rows << ", invert " << options.invert << ", first mirrored "
        << options.first_mirrored << ", alternate " << options.alternate;
  }
}

TEST_P(PlaceRows, WritesNothingBeyondTheRows) {
  for (std::int64_t width = 0; width < 1200; ++width) {
    const Bytes src(static_cast<std::size_t>(3 * packed_bytes(width)), std::byte{0xFF});
    Bytes dst(src.size() + 128, std::byte{0xA5});
    kernels().place_rows(dst, src, width, 3, {.alternate = true});
    for (std::size_t i = src.size(); i < dst.size(); ++i) {
      ASSERT_EQ(dst[i], std::byte{0xA5}) << "width " << width << ", byte " << i;
    }
  }
}

TEST_P(PlaceRows, GivesTheRowsBackWhenDoneTwice) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  for (const std::int64_t width : {3500, 27489, 4096, 1}) {
    const RowOptions options{.invert = true, .first_mirrored = true, .alternate = true};
    const Bytes src = dice.bytes(5 * packed_bytes(width));
    Bytes clean(src.size());
    Bytes once(src.size());
    Bytes twice(src.size());
    kernels().place_rows(clean, src, width, 5, {});
    kernels().place_rows(once, clean, width, 5, options);
    kernels().place_rows(twice, once, width, 5, options);
    EXPECT_EQ(twice, clean) << "width " << width;
  }
}

TEST(PlaceLine, TakesTheBestKernelsOfThisProcessor) {
  const Bytes src{std::byte{0b1100'0000}, std::byte{0b0100'0000}};
  Bytes dst(3, std::byte{0xFF});
  place_line(dst, 7, src, 0, 10, {.mirror = true, .invert = false});
  EXPECT_EQ(dst, (Bytes{std::byte{0xFF}, std::byte{0b0000'0001}, std::byte{0xFF}}));
  place_line(dst, 7, src, 1, 3, {.invert = true});
  EXPECT_EQ(dst, (Bytes{std::byte{0xFE}, std::byte{0b1100'0001}, std::byte{0xFF}}));
  Bytes row(2);
  place_rows(row, src, 10, 1, {.invert = true});
  EXPECT_EQ(row, (Bytes{std::byte{0b0011'1111}, std::byte{0b1000'0000}}));
}

}  // namespace
}  // namespace gravure::raster
