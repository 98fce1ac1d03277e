#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gravure::raster {

/// Bit matrix of `rows` x `cols` to `cols` x `rows`: bit r of row c of `dst` is bit c of row r of `src`.
///
/// Rows are packed without padding, of packed_bytes(cols) bytes in `src` and packed_bytes(rows) bytes in `dst`; unused
/// low bits of `dst` become 0, those of `src` may hold anything. No byte outside the two matrices is touched. The spans
/// must not overlap. Fastest where rows of `dst` are a multiple of 64 bytes from a 64-byte boundary.
void transpose(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t rows, std::int64_t cols);

}  // namespace gravure::raster
