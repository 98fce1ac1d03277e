#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "gravure/core/device_link.hpp"
#include "gravure/core/error.hpp"

namespace gravure::protocol {

/// Of registers, frames and status messages together: what host and board must agree on.
inline constexpr std::uint16_t kProtocolVersion = 1;
inline constexpr std::size_t kStatusBytes = 64;

/// A status message as it goes over bulk IN (docs/protocol.md).
std::array<std::byte, kStatusBytes> encode_status(const BoardStatus& status);

/// version_mismatch, naming both versions, before anything else is looked at; device where length, mark, checksum,
/// state or fault are none of ours.
Result<BoardStatus> decode_status(std::span<const std::byte> message);

}  // namespace gravure::protocol
