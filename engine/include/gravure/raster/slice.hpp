#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "gravure/raster/threshold.hpp"

/// Depth maps to layers. A sample v between vmin (no pulse) and vmax (`levels` pulses) asks for
///
///     count(v) = floor( (v - vmin) * levels / (vmax - vmin) + 1/2 )      (rounded to nearest, halves up)
///
/// pulses, and layer r = 0, 1, ... levels - 1 fires where count(v) > r. With R = |vmax - vmin| that is
///
///     v >= vmin + ceil( (2 r + 1) R / (2 levels) )      where vmin < vmax,
///     v <= vmin - ceil( (2 r + 1) R / (2 levels) )      where vmin > vmax (dark means deep).
///
/// So one comparison with an integer makes a layer, and nothing is rounded twice. Samples beyond vmax count as vmax,
/// samples beyond vmin as vmin.
namespace gravure::raster {

/// How the depth of a map is divided.
struct SliceRange {
  std::int64_t levels = 1;  ///< 1 .. 2^62: pulses at vmax, and number of layers
  std::uint32_t vmin = 0;   ///< the sample that gets no pulse
  std::uint32_t vmax = 0;   ///< the sample that gets all; differs from vmin, and may be below it
};

/// The limit of layer `level` (0 .. levels - 1) by the formula above, exact for every argument. It lies between vmin
/// (excluded) and vmax (included). Compare with slice_where().
std::uint32_t slice_threshold(std::int64_t level, std::int64_t levels, std::uint32_t vmin, std::uint32_t vmax);

/// The direction in which slice_threshold() is to be compared.
constexpr Where slice_where(std::uint32_t vmin, std::uint32_t vmax) {
  return vmin < vmax ? Where::at_least : Where::at_most;
}

/// Number of pulses a sample asks for: count(v) above, 0 .. levels.
std::int64_t slice_count(std::uint32_t sample, const SliceRange& range);

/// Layers first_level, first_level + 1, ... of `rows` rows of `width` samples (without padding), one span of
/// rows * packed_bytes(width) bytes for each layer; unused low bits 0. The samples are read once, in pieces that stay
/// in the first-level cache while all layers are made from them. vmin and vmax must fit the samples' type.
void slice_rows_u16(std::span<const std::span<std::byte>> layers, std::int64_t first_level,
                    std::span<const std::uint16_t> src, std::int64_t width, std::int64_t rows, const SliceRange& range);
void slice_rows_u8(std::span<const std::span<std::byte>> layers, std::int64_t first_level,
                   std::span<const std::uint8_t> src, std::int64_t width, std::int64_t rows, const SliceRange& range);

}  // namespace gravure::raster
