#include "avx2.hpp"

#ifdef GRAVURE_HAS_X86_KERNELS

#include <immintrin.h>

#include <array>
#include <cassert>

#include "gravure/raster/place.hpp"
#include "words.hpp"

namespace gravure::raster::avx2 {
namespace {

/// Writes the positions of the ones in `differ`, first bit at `first`, and returns how many there are. Always writes
/// in fours, up to three of them beyond the last: a loop whose length is guessed wrong costs more.
GRAVURE_AVX2 inline std::size_t write_edges(std::uint32_t* to, std::uint64_t differ, std::uint32_t first) {
  const auto count = static_cast<std::size_t>(_mm_popcnt_u64(differ));
  for (std::size_t k = 0; k < count; k += 4) {
    for (std::size_t j = 0; j < 4; ++j) {
      const auto bit = static_cast<std::uint32_t>(_lzcnt_u64(differ));
      to[k + j] = first + bit;
      differ = _bzhi_u64(differ, 63u - bit);  // a word without ones stays as it is
    }
  }
  return count;
}

}  // namespace

GRAVURE_AVX2 void append_runs(std::span<const std::byte> line, std::int64_t width, std::vector<std::uint32_t>& edges) {
  assert(width >= 0 && width <= 0xFFFFFFFF && packed_bytes(width) <= static_cast<std::int64_t>(line.size()));
  std::array<std::uint32_t, 1024 + 64 + 4> buffer;
  std::size_t filled = 0;
  std::uint64_t before = 0;  // the last bit of the word before
  for (std::int64_t first = 0; first < width; first += 64) {
    const std::int64_t left = width - first;
    const std::byte* at = line.data() + first / 8;
    std::uint64_t word = 0;
    std::uint64_t differ = 0;
    if (left >= 64) {
      word = detail::load_stream(at);
      differ = word ^ (word >> 1 | before << 63);
      before = word & 1;
    } else {
      word = detail::load_stream_part(at, packed_bytes(left));
      differ = (word ^ (word >> 1 | before << 63)) & ~(~std::uint64_t{0} >> left);
      before = word >> (64 - left) & 1;
    }
    filled += write_edges(buffer.data() + filled, differ, static_cast<std::uint32_t>(first));
    if (filled >= 1024) {
      edges.insert(edges.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(filled));
      filled = 0;
    }
  }
  if (before != 0) {
    buffer[filled++] = static_cast<std::uint32_t>(width);
  }
  edges.insert(edges.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(filled));
}

}  // namespace gravure::raster::avx2

#endif
