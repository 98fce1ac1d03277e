#include "gravure/raster/copy_bits.hpp"

#include <algorithm>
#include <cstring>

namespace gravure::raster {
namespace {

constexpr std::int64_t kWordBytes = 8;
constexpr std::int64_t kAtOnce = 56;  ///< bits that lie in a word wherever in its first byte they start

/// The first bytes of `bytes` as the leading ones of a word; 0 where there are fewer.
std::uint64_t load(std::span<const std::byte> bytes) noexcept {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes.data(), std::min(bytes.size(), sizeof word));
  return __builtin_bswap64(word);
}

void store(std::span<std::byte> bytes, std::uint64_t word) noexcept {
  word = __builtin_bswap64(word);
  std::memcpy(bytes.data(), &word, std::min(bytes.size(), sizeof word));
}

}  // namespace

static_assert(kAtOnce + 7 <= 8 * kWordBytes);

void copy_bits(std::span<std::byte> dst, std::int64_t to, std::span<const std::byte> src, std::int64_t from,
               std::int64_t count, bool invert) noexcept {
  const std::uint64_t flip = invert ? ~std::uint64_t{0} : 0;
  while (count > 0) {
    const std::int64_t now = std::min(count, kAtOnce);
    const std::uint64_t mask = ~std::uint64_t{0} << static_cast<unsigned>(8 * kWordBytes - now);
    const std::uint64_t bits =
        ((load(src.subspan(static_cast<std::size_t>(from / 8))) << static_cast<unsigned>(from % 8)) ^ flip) & mask;
    const std::span<std::byte> at = dst.subspan(static_cast<std::size_t>(to / 8));
    store(at, load(at) | (bits >> static_cast<unsigned>(to % 8)));
    to += now;
    from += now;
    count -= now;
  }
}

}  // namespace gravure::raster
