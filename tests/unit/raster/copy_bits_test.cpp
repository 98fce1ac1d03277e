#include "gravure/raster/copy_bits.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "dice.hpp"

namespace gravure::test {
namespace {

bool bit(const std::vector<std::byte>& bytes, std::int64_t at) {
  return (std::to_integer<unsigned>(bytes[static_cast<std::size_t>(at / 8)]) >> (7 - at % 8) & 1U) != 0;
}

TEST(CopyBits, MovesEveryBitAndLeavesTheOthers) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 3000; ++trial) {
    const std::int64_t count = dice.between(0, 200);
    const std::int64_t from = dice.between(0, 70);
    const std::int64_t to = dice.between(0, 70);
    const bool invert = dice.coin();
    // No byte more than the bits need, so that reading or writing past them shows.
    std::vector<std::byte> src(static_cast<std::size_t>((from + count + 7) / 8));
    std::vector<std::byte> dst(static_cast<std::size_t>((to + count + 7) / 8));
    for (std::byte& byte : src) {
      byte = static_cast<std::byte>(dice.word());
    }
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(dst.size()) * 8; ++i) {
      if ((i < to || i >= to + count) && dice.coin()) {
        dst[static_cast<std::size_t>(i / 8)] |= static_cast<std::byte>(0x80U >> (i % 8));
      }
    }
    const std::vector<std::byte> before = dst;
    raster::copy_bits(dst, to, src, from, count, invert);
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(dst.size()) * 8; ++i) {
      const bool copied = i >= to && i < to + count;
      ASSERT_EQ(bit(dst, i), copied ? bit(src, from + i - to) != invert : bit(before, i))
          << "bit " << i << " of " << count << " from " << from << " to " << to;
    }
  }
}

}  // namespace
}  // namespace gravure::test
