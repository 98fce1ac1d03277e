#include "gravure/protocol/frame.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "gravure/core/crc32c.hpp"
#include "little_endian.hpp"

namespace gravure::protocol {
namespace {

constexpr std::uint32_t kFrameMark = 0xA5;
constexpr std::uint32_t kLineKind = 0x0156'5247;  // "GRV", then 1
constexpr std::size_t kCheckBytes = 4;
constexpr std::size_t kBeforeBits = kFrameBytes - kCheckBytes;
constexpr std::size_t kKindEnd = 5;  ///< bytes until mark, name and kind are through

std::uint32_t frame_checksum(std::span<const std::byte> from_mark_to_bits) {
  return ~crc32c_continue(kCrc32cStart, from_mark_to_bits.subspan(1));
}

Error not_a_frame(const std::string& what) {
  return {ErrorCode::device, "line frame: " + what};
}

/// The bytes of it that are there.
bool begins_right(std::span<const std::byte> stream) {
  std::array<std::byte, kKindEnd> front{};
  ByteWriter out(front);
  out.put(kFrameMark, 1);
  out.put(kLineKind, 4);
  const std::size_t there = std::min(stream.size(), front.size());
  return std::equal(front.begin(), front.begin() + static_cast<std::ptrdiff_t>(there), stream.begin());
}

}  // namespace

void append_frame(std::vector<std::byte>& stream, const FrameHead& head, std::span<const std::byte> bits) {
  const std::size_t begin = stream.size();
  stream.resize(begin + kBeforeBits);
  ByteWriter front{std::span(stream).subspan(begin)};
  front.put(kFrameMark, 1);
  for (const std::uint32_t field : {kLineKind, head.sequence, head.revolution, head.line, head.first_slot,
                                    static_cast<std::uint32_t>(bits.size())}) {
    front.put(field, 4);
  }
  stream.insert(stream.end(), bits.begin(), bits.end());
  const std::uint32_t crc = frame_checksum(std::span(stream).subspan(begin));
  stream.resize(stream.size() + kCheckBytes);
  ByteWriter(std::span(stream).last(kCheckBytes)).put(crc, kCheckBytes);
}

Result<std::optional<Frame>> decode_frame(std::span<const std::byte> stream) {
  if (!begins_right(stream)) {
    return not_a_frame("it does not begin with A5 and GRV and kind 1");
  }
  if (stream.size() < kBeforeBits) {
    return std::optional<Frame>();
  }
  ByteReader in(stream.subspan(kKindEnd));
  Frame frame;
  for (std::uint32_t* field :
       {&frame.head.sequence, &frame.head.revolution, &frame.head.line, &frame.head.first_slot}) {
    *field = static_cast<std::uint32_t>(in.take(4));
  }
  const std::uint64_t length = in.take(4);
  if (length > kMostFrameBits) {
    return not_a_frame(std::to_string(length) + " bytes of bits, at most " + std::to_string(kMostFrameBits));
  }
  if (stream.size() < kFrameBytes + length) {
    return std::optional<Frame>();
  }
  frame.bits = stream.subspan(kBeforeBits, length);
  if (ByteReader(stream.subspan(kBeforeBits + length)).take(kCheckBytes) !=
      frame_checksum(stream.first(kBeforeBits + length))) {
    return not_a_frame("checksum of sequence " + std::to_string(frame.head.sequence) + " is wrong");
  }
  return std::optional(frame);
}

}  // namespace gravure::protocol
