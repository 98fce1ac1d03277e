#include "pack_bits.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "temp_folder.hpp"

namespace gravure::test {
namespace {

TEST(PackBits, GivesTheBitsOneByOneAtEveryLength) {
  const std::uint32_t seed = image_test_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  std::mt19937 rng(seed);
  for (std::size_t count = 0; count < 200; ++count) {
    std::vector<std::uint8_t> samples(count);
    for (std::uint8_t& sample : samples) {
      sample = (rng() & 1U) != 0 ? 255 : 0;
    }
    std::vector<std::byte> packed((count + 7) / 8 + 1, std::byte{0xEE});
    oiio::pack_bits(samples.data(), static_cast<std::int64_t>(count), packed.data());
    for (std::size_t i = 0; i < (count + 7) / 8 * 8; ++i) {
      const bool bit = (packed[i / 8] & static_cast<std::byte>(0x80U >> (i % 8))) != std::byte{0};
      ASSERT_EQ(bit, i < count && samples[i] == 255) << i << " of " << count;
    }
    ASSERT_EQ(packed.back(), std::byte{0xEE}) << "nothing behind the last byte is touched";
  }
}

}  // namespace
}  // namespace gravure::test
