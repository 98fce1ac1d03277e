#include "pack_bits.hpp"

#include <bit>
#include <cstring>

namespace gravure::oiio {

void pack_bits(const std::uint8_t* samples, std::int64_t count, std::byte* out) {
  static_assert(std::endian::native == std::endian::little);
  for (; count >= 8; count -= 8, samples += 8, ++out) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, samples, 8);
    // Byte i holds its pixel in bit 0; the product moves it to bit 63 - i without any two meeting.
    *out = static_cast<std::byte>((eight & 0x0101010101010101U) * 0x8040201008040201U >> 56);
  }
  if (count > 0) {
    unsigned last = 0;
    for (std::int64_t i = 0; i < count; ++i) {
      last |= (samples[i] & 1U) << static_cast<unsigned>(7 - i);
    }
    *out = static_cast<std::byte>(last);
  }
}

}  // namespace gravure::oiio
