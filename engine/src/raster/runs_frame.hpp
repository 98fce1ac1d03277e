#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gravure/raster/place.hpp"
#include "words.hpp"

/// Private to engine/raster: words of a line and their carries around what an instruction set does with a word.
namespace gravure::raster::detail {

/// Edges collected before they are appended; a word may write 64, and up to 16 beyond those it has.
inline constexpr std::size_t kEdgesKept = 1024;
using EdgeBuffer = std::array<std::uint32_t, kEdgesKept + 64 + 16>;

inline void append(std::vector<std::uint32_t>& edges, const EdgeBuffer& buffer, std::size_t count) {
  edges.insert(edges.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(count));
}

/// Leaf::write_edges(to, differ, first) writes first + k for each one of `differ`, bit k counted from the LOW end, and
/// returns how many there are. Inlined always, so that the loop is compiled for the caller's instruction set.
template <class Leaf>
[[gnu::always_inline]] inline void append_runs_with(std::span<const std::byte> line, std::int64_t width,
                                                    std::vector<std::uint32_t>& edges) {
  assert(width >= 0 && width <= 0xFFFFFFFF && packed_bytes(width) <= static_cast<std::int64_t>(line.size()));
  EdgeBuffer buffer;
  std::size_t filled = 0;
  std::uint64_t before = 0;  // the last bit of the word before
  std::int64_t first = 0;
  for (; first + 64 <= width; first += 64) {
    const std::uint64_t word = reverse_in_bytes(load_little(line.data() + first / 8));
    filled += Leaf::write_edges(buffer.data() + filled, word ^ (word << 1 | before), static_cast<std::uint32_t>(first));
    before = word >> 63;
    if (filled >= kEdgesKept) {
      append(edges, buffer, filled);
      filled = 0;
    }
  }
  if (const int rest = static_cast<int>(width - first); rest > 0) {
    std::uint64_t word = load_stream_part(line.data() + first / 8, packed_bytes(rest));
    word = reverse_in_bytes(byte_swap(word)) & ~(~std::uint64_t{0} << rest);
    const std::uint64_t differ = (word ^ (word << 1 | before)) & ~(~std::uint64_t{0} << rest);
    filled += Leaf::write_edges(buffer.data() + filled, differ, static_cast<std::uint32_t>(first));
    before = word >> (rest - 1);
  }
  if (before != 0) {
    buffer[filled++] = static_cast<std::uint32_t>(width);
  }
  append(edges, buffer, filled);
}

}  // namespace gravure::raster::detail
