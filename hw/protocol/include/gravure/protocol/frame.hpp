#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::protocol {

/// Bytes of a line frame beside its bits (docs/protocol.md).
inline constexpr std::size_t kFrameBytes = 29;
/// Most bytes of bits: a window has 24 bits of slots.
inline constexpr std::size_t kMostFrameBits = ((std::size_t{1} << 24) - 1 + 7) / 8;

/// What stands before the bits of a line frame.
struct FrameHead {
  std::uint32_t sequence = 0;  ///< frames since the position was set
  std::uint32_t revolution = 0;
  std::uint32_t line = 0;
  std::uint32_t first_slot = 0;  ///< of the window
  friend bool operator==(const FrameHead&, const FrameHead&) = default;
};

/// Appends the frame of a line to the stream: mark, kind, head, length, bits, CRC-32C.
void append_frame(std::vector<std::byte>& stream, const FrameHead& head, std::span<const std::byte> bits);

struct Frame {
  FrameHead head;
  std::span<const std::byte> bits;  ///< within the stream it was taken from
  std::size_t size() const noexcept { return kFrameBytes + bits.size(); }
};

/// The frame at the begin of the stream; none while bytes of it are missing. device where mark, name, kind, length or
/// checksum are wrong: as soon as it shows.
Result<std::optional<Frame>> decode_frame(std::span<const std::byte> stream);

}  // namespace gravure::protocol
