#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gravure::protocol {

/// Bytes of a line frame beside its bits (docs/protocol.md).
inline constexpr std::size_t kFrameBytes = 29;

/// What stands before the bits of a line frame.
struct FrameHead {
  std::uint32_t sequence = 0;  ///< frames since the position was set
  std::uint32_t revolution = 0;
  std::uint32_t line = 0;
  std::uint32_t first_slot = 0;  ///< of the window
};

/// Appends the frame of a line to the stream: mark, kind, head, length, bits, CRC-32C.
void append_frame(std::vector<std::byte>& stream, const FrameHead& head, std::span<const std::byte> bits);

}  // namespace gravure::protocol
