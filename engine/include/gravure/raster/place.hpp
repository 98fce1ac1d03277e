#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

/// Bits are packed MSB first everywhere in gravure::raster: bit 0 of a line is the top bit of its first byte.
/// Sizes that do not fit the spans given are a mistake of the caller and are asserted, not reported.
namespace gravure::raster {

/// Bytes that hold `bits` packed bits.
constexpr std::int64_t packed_bytes(std::int64_t bits) {
  return (bits + 7) / 8;
}

struct PlaceOptions {
  bool mirror = false;  ///< the first bit taken becomes the last one placed
  bool invert = false;  ///< ones become zeros and zeros ones
};

/// Copies bits [src_bit, src_bit + width) of `src` to bits [dst_bit, dst_bit + width) of `dst`, mirrored and inverted
/// as asked.
///
/// Every other bit of `dst` is kept, those that share the first and the last byte included. Reads no byte of `src` and
/// writes no byte of `dst` that holds none of these bits: neither span needs guard bytes or an alignment. Other bits
/// of `src` may hold anything. `dst` and `src` must not overlap.
void place_line(std::span<std::byte> dst, std::int64_t dst_bit, std::span<const std::byte> src, std::int64_t src_bit,
                std::int64_t width, PlaceOptions options = {});

struct RowOptions {
  bool invert = false;          ///< ones become zeros and zeros ones
  bool first_mirrored = false;  ///< the first row is mirrored left to right
  bool alternate = false;       ///< every row has the other direction than the row before it; else all as the first
};

/// Copies `rows` rows of `width` bits, each of packed_bytes(width) bytes without padding between them, mirrored and
/// inverted as asked. Unused low bits in the last byte of a row become 0 whatever they were in `src`, also when
/// inverting. Reads and writes rows * packed_bytes(width) bytes, no more. `dst` and `src` must not overlap.
void place_rows(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t width, std::int64_t rows,
                RowOptions options = {});

}  // namespace gravure::raster
