#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gravure::grv {

/// All last bytes of lines of `line_bytes` OR-ed together: shows whether a bit beyond the last pixel is set anywhere.
std::uint8_t merge_last_bytes(std::span<const std::byte> lines, std::int64_t line_bytes) noexcept;

/// The bits of a line's last byte that belong to no pixel.
constexpr std::uint8_t unused_bits(std::int64_t pixels) {
  return static_cast<std::uint8_t>((1U << ((8 - pixels % 8) % 8)) - 1U);
}

}  // namespace gravure::grv
