#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "gravure/raster/place.hpp"
#include "words.hpp"

/// Private to engine/raster: heads, tails and rows around the whole bytes that an instruction set places.
///
/// A Leaf has two functions, which read no byte that holds none of the bits named:
///   copy_bits(dst, bytes, src, first, flip)    whole bytes of dst from src bits first, first + 1, ...
///   mirror_bits(dst, bytes, src, end, flip)    whole bytes of dst from src bits end - 1, end - 2, ...
/// `flip` is 0xFF to invert, else 0.
namespace gravure::raster::detail {

/// `count` bits for the output bits from `done` on, as a number, of bits [first, first + width) of `src`.
inline unsigned placed_bits(const std::byte* src, std::int64_t first, std::int64_t width, std::int64_t done, int count,
                            bool mirror) {
  if (!mirror) {
    return take_bits(src, first + done, count);
  }
  return reverse_byte(take_bits(src, first + width - done - count, count)) >> (8 - count);
}

/// Puts `count` bits into *dst from bit `phase` on and keeps the others.
inline void merge_bits(std::byte* dst, int phase, int count, unsigned bits) {
  const int shift = 8 - phase - count;
  const unsigned mask = ((1u << count) - 1) << shift;
  *dst = static_cast<std::byte>((std::to_integer<unsigned>(*dst) & ~mask) | ((bits << shift) & mask));
}

constexpr std::int64_t kShort = 57;  ///< bits that lie in a word wherever in its first byte they start

/// A line of 1 to kShort bits as one word: the stretches of helical lines are often no longer.
inline void place_short(std::byte* dst, int dst_phase, const std::byte* src, int src_phase, int width,
                        PlaceOptions options) {
  std::uint64_t word = load_stream_part(src, packed_bytes(src_phase + width)) << src_phase;
  if (options.mirror) {
    word = byte_swap(reverse_in_bytes(word)) << (64 - width);
  }
  const std::uint64_t mask = (~std::uint64_t{0} << (64 - width)) >> dst_phase;
  const std::uint64_t bits = ((options.invert ? ~word : word) >> dst_phase) & mask;
  const std::int64_t bytes = packed_bytes(dst_phase + width);
  const std::uint64_t ends = (std::to_integer<std::uint64_t>(dst[0]) << 56) |
                             (std::to_integer<std::uint64_t>(dst[bytes - 1]) << (64 - 8 * bytes));
  store_stream_part(dst, (ends & ~mask) | bits, bytes);
}

template <class Leaf>
void place_line_with(std::span<std::byte> dst, std::int64_t dst_bit, std::span<const std::byte> src,
                     std::int64_t src_bit, std::int64_t width, PlaceOptions options) {
  assert(width >= 0 && dst_bit >= 0 && src_bit >= 0);
  assert(packed_bytes(dst_bit + width) <= static_cast<std::int64_t>(dst.size()));
  assert(packed_bytes(src_bit + width) <= static_cast<std::int64_t>(src.size()));
  if (width <= kShort) {
    if (width > 0) {
      place_short(dst.data() + (dst_bit >> 3), static_cast<int>(dst_bit & 7), src.data() + (src_bit >> 3),
                  static_cast<int>(src_bit & 7), static_cast<int>(width), options);
    }
    return;
  }
  const unsigned flip = options.invert ? 0xFFu : 0u;
  std::byte* at = dst.data() + (dst_bit >> 3);
  std::int64_t done = 0;
  if (const int phase = static_cast<int>(dst_bit & 7); phase != 0) {
    const int count = 8 - phase;  // there are more
    merge_bits(at++, phase, count, placed_bits(src.data(), src_bit, width, 0, count, options.mirror) ^ flip);
    done = count;
  }
  const std::int64_t bytes = (width - done) >> 3;
  if (options.mirror) {
    Leaf::mirror_bits(at, bytes, src.data(), src_bit + width - done, flip);
  } else {
    Leaf::copy_bits(at, bytes, src.data(), src_bit + done, flip);
  }
  done += 8 * bytes;
  if (const int rest = static_cast<int>(width - done); rest != 0) {
    merge_bits(at + bytes, 0, rest, placed_bits(src.data(), src_bit, width, done, rest, options.mirror) ^ flip);
  }
}

template <class Leaf>
void place_rows_with(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t width, std::int64_t rows,
                     RowOptions options) {
  assert(width >= 0 && rows >= 0);
  const std::int64_t stride = packed_bytes(width);
  assert(rows * stride <= static_cast<std::int64_t>(dst.size()));
  assert(rows * stride <= static_cast<std::int64_t>(src.size()));
  const unsigned flip = options.invert ? 0xFFu : 0u;
  const std::int64_t bytes = width >> 3;
  const int rest = static_cast<int>(width & 7);
  std::byte* to = dst.data();
  const std::byte* from = src.data();
  bool mirror = options.first_mirrored;
  for (std::int64_t row = 0; row < rows; ++row, to += stride, from += stride) {
    if (mirror) {
      Leaf::mirror_bits(to, bytes, from, width, flip);
    } else {
      Leaf::copy_bits(to, bytes, from, 0, flip);
    }
    if (rest != 0) {
      const unsigned last = placed_bits(from, 0, width, 8 * bytes, rest, mirror) << (8 - rest);
      to[bytes] = static_cast<std::byte>((last ^ flip) & top_bits(rest));
    }
    mirror = mirror != options.alternate;
  }
}

}  // namespace gravure::raster::detail
