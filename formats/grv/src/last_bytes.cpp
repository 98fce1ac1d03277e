#include "last_bytes.hpp"

namespace gravure::grv {

std::uint8_t merge_last_bytes(std::span<const std::byte> lines, std::int64_t line_bytes) noexcept {
  std::byte merged{0};
  const auto step = static_cast<std::size_t>(line_bytes);
  for (std::size_t last = step - 1; last < lines.size(); last += step) {
    merged |= lines[last];
  }
  return std::to_integer<std::uint8_t>(merged);
}

}  // namespace gravure::grv
