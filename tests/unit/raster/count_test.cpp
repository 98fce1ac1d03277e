#include "gravure/raster/count.hpp"

#include "raster_support.hpp"

namespace gravure::raster {
namespace {

class Count : public KernelTest {};
INSTANTIATE_TEST_SUITE_P(Raster, Count, kEveryIsa, kIsaName);

TEST_P(Count, OnesEqualBitByBit) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  for (int trial = 0; trial < 20000; ++trial) {
    const Bytes bits = dice.bytes(dice.size(2000));
    std::int64_t expected = 0;
    for (const std::byte byte : bits) {
      expected += __builtin_popcount(std::to_integer<unsigned>(byte));
    }
    ASSERT_EQ(kernels().popcount(bits), expected) << bits.size() << " bytes";
  }
}

TEST_P(Count, OnesOfAMebibyteOfOnesDoNotOverflow) {
  const Bytes bits((1 << 20) + 13, std::byte{0xFF});
  EXPECT_EQ(kernels().popcount(bits), 8 * ((1 << 20) + 13));
  EXPECT_EQ(kernels().count_differences(bits, Bytes(bits.size())), 8 * ((1 << 20) + 13));
}

TEST_P(Count, DifferencesEqualBitByBit) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  for (int trial = 0; trial < 20000; ++trial) {
    const Bytes a = dice.bytes(dice.size(1000));
    Bytes b = a;
    std::int64_t first = -1;
    std::int64_t count = 0;
    const std::int64_t flips = a.empty() ? 0 : dice.up_to(4);
    for (std::int64_t k = 0; k < flips; ++k) {
      const std::int64_t bit = dice.up_to(8 * static_cast<std::int64_t>(a.size()) - 1);
      set_bit(b, bit, !get_bit(b, bit));
    }
    for (std::int64_t bit = 8 * static_cast<std::int64_t>(a.size()) - 1; bit >= 0; --bit) {
      if (get_bit(a, bit) != get_bit(b, bit)) {
        first = bit;
        ++count;
      }
    }
    ASSERT_EQ(kernels().first_difference(a, b), first) << a.size() << " bytes";
    ASSERT_EQ(kernels().count_differences(a, b), count) << a.size() << " bytes";
  }
}

TEST(Count, TakesTheBestKernelsOfThisProcessor) {
  const Bytes a{std::byte{0x0F}, std::byte{0x80}};
  const Bytes b{std::byte{0x0F}, std::byte{0x03}};
  EXPECT_EQ(popcount(a), 5);
  EXPECT_EQ(first_difference(a, b), 8);
  EXPECT_EQ(first_difference(a, a), -1);
  EXPECT_EQ(count_differences(a, b), 3);
}

}  // namespace
}  // namespace gravure::raster
