#include "bit_count.hpp"

#include <bit>
#include <cstring>

namespace gravure::grv {
namespace {

std::int64_t count_words(const std::byte* bytes, std::size_t words) noexcept {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < words; ++i) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + 8 * i, sizeof word);
    count += std::popcount(word);
  }
  return count;
}

#if defined(__x86_64__)
// Baseline x86-64 has no popcount instruction, every machine of the last fifteen years does.
__attribute__((target("popcnt"))) std::int64_t count_words_popcnt(const std::byte* bytes, std::size_t words) noexcept {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < words; ++i) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + 8 * i, sizeof word);
    count += __builtin_popcountll(word);
  }
  return count;
}
#endif

}  // namespace

std::int64_t count_bits(std::span<const std::byte> bytes) noexcept {
  const std::size_t words = bytes.size() / 8;
  std::int64_t count = 0;
#if defined(__x86_64__)
  count = __builtin_cpu_supports("popcnt") != 0 ? count_words_popcnt(bytes.data(), words)
                                                : count_words(bytes.data(), words);
#else
  count = count_words(bytes.data(), words);
#endif
  for (const std::byte byte : bytes.subspan(8 * words)) {
    count += std::popcount(std::to_integer<unsigned>(byte));
  }
  return count;
}

std::uint8_t merge_last_bytes(std::span<const std::byte> lines, std::int64_t line_bytes) noexcept {
  std::byte merged{0};
  const auto step = static_cast<std::size_t>(line_bytes);
  for (std::size_t last = step - 1; last < lines.size(); last += step) {
    merged |= lines[last];
  }
  return std::to_integer<std::uint8_t>(merged);
}

}  // namespace gravure::grv
