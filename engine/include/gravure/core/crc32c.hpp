#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gravure {

/// CRC-32C (Castagnoli, reflected polynomial 0x82F63B78). Start with kCrc32cStart, continue over the parts of the
/// message, invert at the end: ~crc32c_continue(kCrc32cStart, "123456789") == 0xE3069283.
inline constexpr std::uint32_t kCrc32cStart = 0xFFFFFFFFU;

/// The fastest form this processor has.
std::uint32_t crc32c_continue(std::uint32_t state, std::span<const std::byte> bytes) noexcept;
/// By table, anywhere.
std::uint32_t crc32c_portable(std::uint32_t state, std::span<const std::byte> bytes) noexcept;

}  // namespace gravure
