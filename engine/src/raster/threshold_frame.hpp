#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "gravure/raster/place.hpp"
#include "gravure/raster/threshold.hpp"

/// Private to engine/raster: rows around Leaf::threshold_row(dst, src, width, limit, where).
namespace gravure::raster::detail {

template <class Leaf, class Sample>
void threshold_rows_with(std::span<std::byte> dst, std::span<const Sample> src, std::int64_t width, std::int64_t rows,
                         Sample limit, Where where) {
  assert(width >= 0 && rows >= 0);
  assert(rows * width <= static_cast<std::int64_t>(src.size()));
  assert(rows * packed_bytes(width) <= static_cast<std::int64_t>(dst.size()));
  for (std::int64_t row = 0; row < rows; ++row) {
    Leaf::threshold_row(dst.data() + row * packed_bytes(width), src.data() + row * width, width, limit, where);
  }
}

}  // namespace gravure::raster::detail
