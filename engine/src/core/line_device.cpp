#include "gravure/core/line_device.hpp"

#include "gravure/core/crc32c.hpp"

namespace gravure {

std::uint32_t frame_crc32c(const LineFrame& frame) noexcept {
  std::byte head[24];
  std::size_t at = 0;
  for (const std::int64_t field : {frame.revolution, frame.line, frame.first_slot}) {
    for (unsigned shift = 0; shift < 64; shift += 8) {
      head[at++] = static_cast<std::byte>(static_cast<std::uint64_t>(field) >> shift);
    }
  }
  return ~crc32c_continue(crc32c_continue(kCrc32cStart, head), frame.bits);
}

}  // namespace gravure
