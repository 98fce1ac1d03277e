#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

#include "portable.hpp"
#include "words.hpp"

namespace gravure::raster::portable {
namespace {

using namespace detail;

using Tile = std::array<std::uint64_t, 64>;

/// Transposes 64 x 64 bits in place: exchanges ever smaller off-diagonal squares, 32 x 32 down to 1 x 1.
void transpose_tile(Tile& tile) {
  std::uint64_t mask = 0x00000000FFFFFFFFu;
  for (unsigned step = 32; step != 0; step >>= 1, mask ^= mask << step) {
    for (unsigned i = 0; i < 64; i = (i + step + 1) & ~step) {
      const std::uint64_t swap = ((tile[i + step] >> step) ^ tile[i]) & mask;
      tile[i] ^= swap;
      tile[i + step] ^= swap << step;
    }
  }
}

}  // namespace

void transpose(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t rows, std::int64_t cols) {
  assert(rows >= 0 && cols >= 0);
  const std::int64_t src_stride = packed_bytes(cols);
  const std::int64_t dst_stride = packed_bytes(rows);
  assert(rows * src_stride <= static_cast<std::int64_t>(src.size()));
  assert(cols * dst_stride <= static_cast<std::int64_t>(dst.size()));
  constexpr std::int64_t kSlab = 512;  // rows whose bits fill one cache line of an output row
  Tile tile;
  for (std::int64_t slab = 0; slab < rows; slab += kSlab) {
    for (std::int64_t col = 0; col < cols; col += 64) {
      for (std::int64_t row = slab; row < std::min(slab + kSlab, rows); row += 64) {
        const std::int64_t in_bytes = std::min<std::int64_t>(8, src_stride - col / 8);
        const std::int64_t in_rows = std::min<std::int64_t>(64, rows - row);
        const std::byte* from = src.data() + row * src_stride + col / 8;
        tile.fill(0);
        for (std::int64_t i = 0; i < in_rows; ++i, from += src_stride) {
          tile[static_cast<std::size_t>(i)] = in_bytes == 8 ? load_stream(from) : load_stream_part(from, in_bytes);
        }
        transpose_tile(tile);
        const std::int64_t out_bytes = std::min<std::int64_t>(8, dst_stride - row / 8);
        const std::int64_t out_rows = std::min<std::int64_t>(64, cols - col);
        std::byte* to = dst.data() + col * dst_stride + row / 8;
        for (std::int64_t i = 0; i < out_rows; ++i, to += dst_stride) {
          const std::uint64_t word = tile[static_cast<std::size_t>(i)];
          out_bytes == 8 ? store_stream(to, word) : store_stream_part(to, word, out_bytes);
        }
      }
    }
  }
}

}  // namespace gravure::raster::portable
