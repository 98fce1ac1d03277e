#include <bit>
#include <cassert>

#include "portable.hpp"
#include "words.hpp"

namespace gravure::raster::portable {

using namespace detail;

std::int64_t popcount(std::span<const std::byte> bits) {
  const auto size = static_cast<std::int64_t>(bits.size());
  const std::byte* at = bits.data();
  std::uint64_t sum = 0;
  std::int64_t i = 0;
  for (; i + 8 <= size; i += 8) {
    sum += ones(load_little(at + i));
  }
  return static_cast<std::int64_t>(sum + ones(load_stream_part(at + i, size - i)));
}

std::int64_t first_difference(std::span<const std::byte> a, std::span<const std::byte> b) {
  assert(a.size() == b.size());
  const auto size = static_cast<std::int64_t>(a.size());
  for (std::int64_t i = 0; i < size; i += 8) {
    const std::int64_t bytes = size - i;
    const std::uint64_t differ = bytes >= 8
                                     ? load_stream(a.data() + i) ^ load_stream(b.data() + i)
                                     : load_stream_part(a.data() + i, bytes) ^ load_stream_part(b.data() + i, bytes);
    if (differ != 0) {
      return 8 * i + std::countl_zero(differ);
    }
  }
  return -1;
}

std::int64_t count_differences(std::span<const std::byte> a, std::span<const std::byte> b) {
  assert(a.size() == b.size());
  const auto size = static_cast<std::int64_t>(a.size());
  std::uint64_t sum = 0;
  std::int64_t i = 0;
  for (; i + 8 <= size; i += 8) {
    sum += ones(load_little(a.data() + i) ^ load_little(b.data() + i));
  }
  sum += ones(load_stream_part(a.data() + i, size - i) ^ load_stream_part(b.data() + i, size - i));
  return static_cast<std::int64_t>(sum);
}

}  // namespace gravure::raster::portable
