#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gravure::raster {

/// Appends the edges of a line of `width` bits (below 2^32) to `edges`: first the positions where the bit differs from
/// the one before it (the one before bit 0 counts as 0), then `width` if the line ends in a one. So an even number is
/// appended, and run k of ones is [edges[2k], edges[2k + 1]). Bits beyond `width` may hold anything.
void append_runs(std::span<const std::byte> line, std::int64_t width, std::vector<std::uint32_t>& edges);

/// Calls `function(first, length)` for each run of ones of the line, left to right.
template <class Function>
void for_each_run(std::span<const std::byte> line, std::int64_t width, Function&& function) {
  std::vector<std::uint32_t> edges;
  append_runs(line, width, edges);
  for (std::size_t k = 0; k + 1 < edges.size(); k += 2) {
    function(std::int64_t{edges[k]}, std::int64_t{edges[k + 1]} - std::int64_t{edges[k]});
  }
}

}  // namespace gravure::raster
