#include "gravure/raster/transpose.hpp"

#include "raster_support.hpp"

namespace gravure::raster {
namespace {

Bytes transposed_bit_by_bit(const Bytes& src, std::int64_t rows, std::int64_t cols) {
  Bytes dst(static_cast<std::size_t>(cols * packed_bytes(rows)));
  for (std::int64_t row = 0; row < rows; ++row) {
    for (std::int64_t col = 0; col < cols; ++col) {
      set_bit(dst, 8 * col * packed_bytes(rows) + row, get_bit(src, 8 * row * packed_bytes(cols) + col));
    }
  }
  return dst;
}

class Transpose : public KernelTest {
 protected:
  void expect_right(Dice& dice, std::int64_t rows, std::int64_t cols, std::int64_t guard) {
    const Bytes src = dice.bytes(rows * packed_bytes(cols));
    const Bytes untouched = dice.bytes(guard);
    Bytes dst = dice.bytes(cols * packed_bytes(rows));
    dst.insert(dst.end(), untouched.begin(), untouched.end());
    kernels().transpose(dst, src, rows, cols);
    Bytes expected = transposed_bit_by_bit(src, rows, cols);
    expected.insert(expected.end(), untouched.begin(), untouched.end());
    ASSERT_TRUE(dst == expected) << rows << " x " << cols;
  }
};
INSTANTIATE_TEST_SUITE_P(Raster, Transpose, kEveryIsa, kIsaName);

TEST_P(Transpose, EqualsBitByBitForRandomSizes) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  for (int trial = 0; trial < 20000; ++trial) {
    const std::int64_t rows = dice.up_to(trial % 100 == 0 ? 700 : 40);
    const std::int64_t cols = dice.up_to(trial % 100 == 0 ? 700 : 40);
    expect_right(dice, rows, cols, dice.up_to(70));
    ASSERT_FALSE(HasFatalFailure());
  }
}

TEST_P(Transpose, EqualsBitByBitAroundItsBlockSizes) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  constexpr std::int64_t kSizes[] = {1, 7, 8, 9, 63, 64, 65, 127, 128, 511, 512, 513, 1024, 1030};
  for (const std::int64_t rows : kSizes) {
    for (const std::int64_t cols : kSizes) {
      expect_right(dice, rows, cols, 64);
      ASSERT_FALSE(HasFatalFailure());
    }
  }
}

TEST_P(Transpose, EqualsPortableOnWholePlanes) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  for (const auto& [rows, cols] :
       {std::pair{4500, 1111}, std::pair{1111, 9000}, std::pair{4096, 4608}, std::pair{4105, 2111}}) {
    const Bytes src = dice.bytes(rows * packed_bytes(cols));
    Bytes dst(static_cast<std::size_t>(cols * packed_bytes(rows)));
    Bytes expected = dst;
    kernels().transpose(dst, src, rows, cols);
    portable().transpose(expected, src, rows, cols);
    ASSERT_TRUE(dst == expected) << rows << " x " << cols;
  }
}

TEST_P(Transpose, GivesTheMatrixBackWhenDoneTwice) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  const Bytes src = dice.bytes(1000 * 160);  // 1280 columns: no unused bits
  Bytes once(1280 * 125);
  Bytes twice(src.size());
  kernels().transpose(once, src, 1000, 1280);
  kernels().transpose(twice, once, 1280, 1000);
  EXPECT_TRUE(twice == src);
}

TEST(Transpose, TakesTheBestKernelsOfThisProcessor) {
  const Bytes src{std::byte{0b1100'0000}, std::byte{0b0111'1111}};
  Bytes dst(3);
  transpose(dst, src, 2, 3);
  EXPECT_EQ(dst, (Bytes{std::byte{0b1000'0000}, std::byte{0b1100'0000}, std::byte{0b0100'0000}}));
}

}  // namespace
}  // namespace gravure::raster
