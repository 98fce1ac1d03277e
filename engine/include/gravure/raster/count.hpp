#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gravure::raster {

/// Number of ones in `bits`, unused bits of the last byte included: the caller keeps those 0, as place_rows() does.
std::int64_t popcount(std::span<const std::byte> bits);

/// Index of the first bit, MSB first, in which `a` and `b` differ; -1 where they are equal. Both have one size.
std::int64_t first_difference(std::span<const std::byte> a, std::span<const std::byte> b);

/// Number of bits in which `a` and `b` differ. Both have one size.
std::int64_t count_differences(std::span<const std::byte> a, std::span<const std::byte> b);

}  // namespace gravure::raster
