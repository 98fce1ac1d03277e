#include "gravure/raster/threshold.hpp"

#include <limits>

#include "raster_support.hpp"

namespace gravure::raster {
namespace {

template <class Sample>
Bytes cut_one_by_one(const std::vector<Sample>& src, std::int64_t width, std::int64_t rows, Sample limit, Where where) {
  Bytes dst(static_cast<std::size_t>(rows * packed_bytes(width)));
  for (std::int64_t row = 0; row < rows; ++row) {
    for (std::int64_t x = 0; x < width; ++x) {
      const Sample sample = src[static_cast<std::size_t>(row * width + x)];
      set_bit(dst, 8 * row * packed_bytes(width) + x, where == Where::at_least ? sample >= limit : sample <= limit);
    }
  }
  return dst;
}

float any_float(Dice& dice) {
  constexpr float kOdd[] = {0.0f,
                            -0.0f,
                            std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity(),
                            std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::denorm_min(),
                            1.0f};
  return dice.up_to(3) == 0 ? kOdd[dice.up_to(6)] : static_cast<float>(dice.up_to(2000) - 1000) / 16.0f;
}

class Threshold : public KernelTest {
 protected:
  /// Compares `kernel` with one comparison a sample; `draw` gives samples, and limits that often equal a sample.
  template <class Sample, class Kernel, class Draw>
  void compare(Kernel kernel, Draw draw) {
    Dice dice;
    SCOPED_TRACE(dice.trace());
    for (int trial = 0; trial < 20000; ++trial) {
      const std::int64_t width = dice.size(1500);
      const std::int64_t rows = dice.up_to(width > 200 ? 2 : 4);
      std::vector<Sample> src(static_cast<std::size_t>(width * rows));
      for (Sample& sample : src) {
        sample = draw(dice);
      }
      const Sample limit = src.empty() || dice.coin() ? draw(dice) : src.back();
      const Where where = dice.coin() ? Where::at_least : Where::at_most;
      Bytes dst = dice.bytes(rows * packed_bytes(width));
      kernel(dst, src, width, rows, limit, where);
      ASSERT_EQ(dst, cut_one_by_one(src, width, rows, limit, where))
          << "width " << width << ", rows " << rows << ", limit " << +limit << ", " << static_cast<int>(where);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(Raster, Threshold, kEveryIsa, kIsaName);

TEST_P(Threshold, OfBytesEqualsOneComparisonASample) {
  compare<std::uint8_t>(kernels().threshold_u8, [](Dice& dice) {
    return static_cast<std::uint8_t>(dice.up_to(5) == 0 ? 255 * dice.up_to(1) : dice.up_to(255));
  });
}

TEST_P(Threshold, OfWordsEqualsOneComparisonASample) {
  compare<std::uint16_t>(kernels().threshold_u16, [](Dice& dice) {
    const std::int64_t near = 0x7FF0 + dice.up_to(0x20);
    return static_cast<std::uint16_t>(dice.coin() ? near : dice.coin() ? 0xFFFF * dice.up_to(1) : dice.up_to(0xFFFF));
  });
}

TEST_P(Threshold, OfFloatsEqualsOneComparisonASampleAndNanGivesZero) {
  compare<float>(kernels().threshold_f32, any_float);
}

TEST_P(Threshold, OfEveryPairOfBytesIsRight) {
  std::vector<std::uint8_t> all(256);
  for (std::size_t v = 0; v < 256; ++v) {
    all[v] = static_cast<std::uint8_t>(v);
  }
  for (unsigned limit = 0; limit < 256; ++limit) {
    for (const Where where : {Where::at_least, Where::at_most}) {
      Bytes dst(32);
      kernels().threshold_u8(dst, all, 256, 1, static_cast<std::uint8_t>(limit), where);
      ASSERT_EQ(dst, cut_one_by_one(all, 256, 1, static_cast<std::uint8_t>(limit), where)) << "limit " << limit;
    }
  }
}

TEST(Threshold, TakesTheBestKernelsOfThisProcessor) {
  const std::vector<std::uint8_t> bytes{0, 127, 128, 255};
  const std::vector<std::uint16_t> words{0, 999, 1000, 65535};
  const std::vector<float> floats{-1.0f, 0.4f, 0.5f, 9.0f};
  Bytes dst(1);
  threshold(dst, bytes, std::uint8_t{128});
  EXPECT_EQ(dst[0], std::byte{0b0011'0000});
  threshold(dst, words, std::uint16_t{999}, Where::at_most);
  EXPECT_EQ(dst[0], std::byte{0b1100'0000});
  threshold(dst, floats, 0.5f);
  EXPECT_EQ(dst[0], std::byte{0b0011'0000});
  Bytes two(2);
  threshold_rows(two, bytes, 2, 2, std::uint8_t{127});
  EXPECT_EQ(two, (Bytes{std::byte{0b0100'0000}, std::byte{0b1100'0000}}));
  threshold_rows(two, words, 2, 2, std::uint16_t{1000});
  EXPECT_EQ(two, (Bytes{std::byte{0}, std::byte{0b1100'0000}}));
  threshold_rows(two, floats, 2, 2, 0.4f, Where::at_most);
  EXPECT_EQ(two, (Bytes{std::byte{0b1100'0000}, std::byte{0}}));
}

}  // namespace
}  // namespace gravure::raster
