#include "gravure/core/crc32c.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "gravure/core/line_device.hpp"

namespace gravure {
namespace {

std::vector<std::byte> bytes_of(const std::string& text) {
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

/// Bit by bit, straight from the definition.
std::uint32_t crc32c_by_bits(const std::vector<std::byte>& bytes) {
  std::uint32_t state = ~0U;
  for (const std::byte byte : bytes) {
    state ^= std::to_integer<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit) {
      state = (state >> 1U) ^ ((state & 1U) != 0 ? 0x82F63B78U : 0U);
    }
  }
  return ~state;
}

TEST(Crc32c, GivesTheCheckValue) {
  const auto bytes = bytes_of("123456789");
  EXPECT_EQ(~crc32c_continue(kCrc32cStart, bytes), 0xE3069283U);
  EXPECT_EQ(~crc32c_portable(kCrc32cStart, bytes), 0xE3069283U);
  EXPECT_EQ(crc32c_by_bits(bytes), 0xE3069283U);
}

TEST(Crc32c, EveryFormEqualsTheDefinitionAtAnyLengthAndSplit) {
  std::mt19937 rng(1);
  for (std::size_t length = 0; length < 300; ++length) {
    std::vector<std::byte> bytes(length);
    for (std::byte& byte : bytes) {
      byte = static_cast<std::byte>(rng() & 0xFFU);
    }
    const std::uint32_t expected = crc32c_by_bits(bytes);
    const std::span<const std::byte> all(bytes);
    const std::size_t cut = length == 0 ? 0 : rng() % length;
    for (const auto form : {crc32c_continue, crc32c_portable}) {
      ASSERT_EQ(~form(kCrc32cStart, all), expected) << length;
      ASSERT_EQ(~form(form(kCrc32cStart, all.first(cut)), all.subspan(cut)), expected) << length << " cut at " << cut;
    }
  }
}

TEST(FrameCrc32c, CoversTheHeadLittleEndianAndTheBits) {
  const auto bits = bytes_of("gravure");
  const LineFrame frame{.revolution = 0x0102030405060708, .line = 9, .first_slot = 0x0A0B, .bits = bits};
  std::string text("\x08\x07\x06\x05\x04\x03\x02\x01\x09\0\0\0\0\0\0\0\x0B\x0A\0\0\0\0\0\0", 24);
  EXPECT_EQ(frame_crc32c(frame), crc32c_by_bits(bytes_of(text + "gravure")));
}

TEST(FrameCrc32c, ChangesWithEverySingleBit) {
  auto bits = bytes_of("gravure");
  LineFrame frame{.revolution = 1, .line = 2, .first_slot = 3, .bits = bits};
  const std::uint32_t before = frame_crc32c(frame);
  for (unsigned bit = 0; bit < 8 * bits.size(); ++bit) {
    bits[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    EXPECT_NE(frame_crc32c(frame), before);
    bits[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
  }
  for (unsigned bit = 0; bit < 63; ++bit) {
    for (std::int64_t* field : {&frame.revolution, &frame.line, &frame.first_slot}) {
      *field ^= std::int64_t{1} << bit;
      EXPECT_NE(frame_crc32c(frame), before);
      *field ^= std::int64_t{1} << bit;
    }
  }
}

TEST(DeviceFault, HasANameOfItsOwn) {
  std::vector<std::string> names;
  for (const DeviceFault fault : {DeviceFault::none, DeviceFault::sequence, DeviceFault::checksum, DeviceFault::shape,
                                  DeviceFault::underrun, DeviceFault::host_silence, DeviceFault::interlock}) {
    const std::string name = to_string(fault);
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 0) << name;
    EXPECT_NE(name, "unknown");
    names.push_back(name);
  }
}

}  // namespace
}  // namespace gravure
