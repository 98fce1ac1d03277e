#include <cstring>

#include "place_frame.hpp"
#include "portable.hpp"

namespace gravure::raster::portable {
namespace {

using namespace detail;

/// 64 bits from bit 8 * `at` + `phase` on; the ninth byte is read only if it holds one of them.
std::uint64_t window(const std::byte* at, int phase) {
  const std::uint64_t word = load_stream(at);
  return phase == 0 ? word : (word << phase) | (std::to_integer<std::uint64_t>(at[8]) >> (8 - phase));
}

struct PlaceLeaf {
  static void copy_bits(std::byte* dst, std::int64_t bytes, const std::byte* src, std::int64_t first, unsigned flip) {
    const std::byte* at = src + (first >> 3);
    const int phase = static_cast<int>(first & 7);
    const std::uint64_t flips = flip * 0x0101010101010101u;
    std::int64_t i = 0;
    for (; i + 8 <= bytes; i += 8) {
      store_stream(dst + i, window(at + i, phase) ^ flips);
    }
    for (; i < bytes; ++i) {
      dst[i] = static_cast<std::byte>(take_bits(at + i, phase, 8) ^ flip);
    }
  }

  static void mirror_bits(std::byte* dst, std::int64_t bytes, const std::byte* src, std::int64_t end, unsigned flip) {
    const int phase = static_cast<int>(end & 7);
    const std::byte* at = src + (end >> 3);
    const std::uint64_t flips = flip * 0x0101010101010101u;
    std::int64_t i = 0;
    for (; i + 8 <= bytes; i += 8) {
      // A word whose bits are reversed whole and stored MSB first is one whose bytes are reversed and stored LSB first.
      store_little(dst + i, reverse_in_bytes(window(at - i - 8, phase)) ^ flips);
    }
    for (; i < bytes; ++i) {
      dst[i] = static_cast<std::byte>(reverse_byte(take_bits(at - i - 1, phase, 8)) ^ flip);
    }
  }
};

}  // namespace

void copy_bits(std::byte* dst, std::int64_t bytes, const std::byte* src, std::int64_t first, unsigned flip) {
  PlaceLeaf::copy_bits(dst, bytes, src, first, flip);
}

void mirror_bits(std::byte* dst, std::int64_t bytes, const std::byte* src, std::int64_t end, unsigned flip) {
  PlaceLeaf::mirror_bits(dst, bytes, src, end, flip);
}

void place_line(std::span<std::byte> dst, std::int64_t dst_bit, std::span<const std::byte> src, std::int64_t src_bit,
                std::int64_t width, PlaceOptions options) {
  place_line_with<PlaceLeaf>(dst, dst_bit, src, src_bit, width, options);
}

void place_rows(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t width, std::int64_t rows,
                RowOptions options) {
  place_rows_with<PlaceLeaf>(dst, src, width, rows, options);
}

}  // namespace gravure::raster::portable
