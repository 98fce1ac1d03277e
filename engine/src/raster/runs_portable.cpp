#include <bit>
#include <cassert>

#include "portable.hpp"
#include "words.hpp"

namespace gravure::raster::portable {

using namespace detail;

void append_runs(std::span<const std::byte> line, std::int64_t width, std::vector<std::uint32_t>& edges) {
  assert(width >= 0 && width <= 0xFFFFFFFF && packed_bytes(width) <= static_cast<std::int64_t>(line.size()));
  std::uint64_t before = 0;  // the last bit of the word before
  for (std::int64_t first = 0; first < width; first += 64) {
    const std::int64_t left = width - first;
    const std::byte* at = line.data() + first / 8;
    const std::uint64_t word = left >= 64 ? load_stream(at) : load_stream_part(at, packed_bytes(left));
    std::uint64_t differ = word ^ (word >> 1 | before << 63);
    if (left < 64) {
      differ &= ~(~std::uint64_t{0} >> left);
    }
    before = word >> (left < 64 ? 64 - left : 0) & 1;
    while (differ != 0) {
      const int bit = std::countl_zero(differ);
      edges.push_back(static_cast<std::uint32_t>(first + bit));
      differ &= ~(std::uint64_t{1} << (63 - bit));
    }
  }
  if (before != 0) {
    edges.push_back(static_cast<std::uint32_t>(width));
  }
}

}  // namespace gravure::raster::portable
