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

/// `count` bits for the output bits from `done` on, as a number.
inline unsigned placed_bits(const std::byte* src, std::int64_t width, std::int64_t done, int count, bool mirror) {
  if (!mirror) {
    return take_bits(src, done, count);
  }
  return reverse_byte(take_bits(src, width - done - count, count)) >> (8 - count);
}

/// Puts `count` bits into *dst from bit `phase` on and keeps the others.
inline void merge_bits(std::byte* dst, int phase, int count, unsigned bits) {
  const int shift = 8 - phase - count;
  const unsigned mask = ((1u << count) - 1) << shift;
  *dst = static_cast<std::byte>((std::to_integer<unsigned>(*dst) & ~mask) | ((bits << shift) & mask));
}

template <class Leaf>
void place_line_with(std::span<std::byte> dst, std::int64_t dst_bit, std::span<const std::byte> src, std::int64_t width,
                     PlaceOptions options) {
  assert(width >= 0 && dst_bit >= 0);
  assert(packed_bytes(dst_bit + width) <= static_cast<std::int64_t>(dst.size()));
  assert(packed_bytes(width) <= static_cast<std::int64_t>(src.size()));
  const unsigned flip = options.invert ? 0xFFu : 0u;
  std::byte* at = dst.data() + (dst_bit >> 3);
  std::int64_t done = 0;
  if (const int phase = static_cast<int>(dst_bit & 7); phase != 0 && width > 0) {
    const int count = width < 8 - phase ? static_cast<int>(width) : 8 - phase;
    merge_bits(at++, phase, count, placed_bits(src.data(), width, 0, count, options.mirror) ^ flip);
    done = count;
  }
  const std::int64_t bytes = (width - done) >> 3;
  if (options.mirror) {
    Leaf::mirror_bits(at, bytes, src.data(), width - done, flip);
  } else {
    Leaf::copy_bits(at, bytes, src.data(), done, flip);
  }
  done += 8 * bytes;
  if (const int rest = static_cast<int>(width - done); rest != 0) {
    merge_bits(at + bytes, 0, rest, placed_bits(src.data(), width, done, rest, options.mirror) ^ flip);
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
      const unsigned last = placed_bits(from, width, 8 * bytes, rest, mirror) << (8 - rest);
      to[bytes] = static_cast<std::byte>((last ^ flip) & top_bits(rest));
    }
    mirror = mirror != options.alternate;
  }
}

}  // namespace gravure::raster::detail
