#include "gravure/protocol/frame.hpp"

#include "gravure/core/crc32c.hpp"
#include "little_endian.hpp"

namespace gravure::protocol {
namespace {

constexpr std::uint32_t kMark = 0xA5;
constexpr std::uint32_t kLineKind = 0x0156'5247;  // "GRV", then 1
constexpr std::size_t kBeforeBits = kFrameBytes - 4;

}  // namespace

void append_frame(std::vector<std::byte>& stream, const FrameHead& head, std::span<const std::byte> bits) {
  const std::size_t begin = stream.size();
  stream.resize(begin + kBeforeBits);
  ByteWriter front(std::span(stream).subspan(begin));
  front.put(kMark, 1);
  for (const std::uint32_t field : {kLineKind, head.sequence, head.revolution, head.line, head.first_slot,
                                    static_cast<std::uint32_t>(bits.size())}) {
    front.put(field, 4);
  }
  stream.insert(stream.end(), bits.begin(), bits.end());
  const std::uint32_t crc = ~crc32c_continue(kCrc32cStart, std::span(stream).subspan(begin + 1));
  stream.resize(stream.size() + 4);
  ByteWriter(std::span(stream).last(4)).put(crc, 4);
}

}  // namespace gravure::protocol
