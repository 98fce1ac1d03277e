#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gravure::raster {

/// Bits [from, from + count) of `src` into bits [to, to + count) of `dst`, which hold 0 before; all packed MSB first.
/// With `invert` their opposites. Other bits of `dst` stay as they are.
void copy_bits(std::span<std::byte> dst, std::int64_t to, std::span<const std::byte> src, std::int64_t from,
               std::int64_t count, bool invert = false) noexcept;

}  // namespace gravure::raster
