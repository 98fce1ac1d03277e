#pragma once

#include <cstddef>
#include <cstdint>

namespace gravure::oiio {

/// Packs `count` samples of 0 or 255 into bits, MSB first; 255 becomes 1. The last byte is filled up with zeros.
void pack_bits(const std::uint8_t* samples, std::int64_t count, std::byte* out);

}  // namespace gravure::oiio
