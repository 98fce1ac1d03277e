#pragma once

#include <cstdint>
#include <vector>

#include "vectors.hpp"

namespace gravure::registration {

/// The points' numbers in the order of a Morton curve (bits of x, y, z interleaved): neighbours in the list are
/// neighbours in space, so that one query finds in the cache what the last one used. Equal codes by number.
std::vector<std::uint32_t> morton_order(const Vectors& points);

}  // namespace gravure::registration
