#include "gravure/raster/slice.hpp"

#include <algorithm>
#include <cassert>

#include "portable.hpp"
#include "slice_frame.hpp"

namespace gravure::raster {
namespace {

__extension__ using Wide = unsigned __int128;  // (2 level + 1) R is below 2^95

struct SliceLeaf {
  template <class Sample>
  static void prepare(detail::Piece<Sample>& piece, const Sample* src, Sample flip) {
    Sample least = static_cast<Sample>(src[0] ^ flip);
    Sample greatest = least;
    for (std::int64_t i = 0; i < piece.size; ++i) {
      const auto sample = static_cast<Sample>(src[i] ^ flip);
      piece.samples[static_cast<std::size_t>(i)] = sample;
      least = std::min(least, sample);
      greatest = std::max(greatest, sample);
    }
    piece.least = least;
    piece.greatest = greatest;
  }

  template <class Sample>
  static void cut(std::byte* dst, const detail::Piece<Sample>& piece, Sample limit) {
    portable::threshold_row(dst, piece.samples.data(), piece.size, limit, Where::at_least);
  }
};

}  // namespace

std::uint32_t slice_threshold(std::int64_t level, std::int64_t levels, std::uint32_t vmin, std::uint32_t vmax) {
  assert(levels >= 1 && levels <= (std::int64_t{1} << 62) && level >= 0 && level < levels && vmin != vmax);
  const std::uint32_t range = vmin < vmax ? vmax - vmin : vmin - vmax;
  const Wide divisor = Wide{2} * static_cast<std::uint64_t>(levels);
  const Wide product = (Wide{2} * static_cast<std::uint64_t>(level) + 1) * range;
  const auto depth = static_cast<std::uint32_t>((product + divisor - 1) / divisor);
  return vmin < vmax ? vmin + depth : vmin - depth;
}

std::int64_t slice_count(std::uint32_t sample, const SliceRange& range) {
  const auto [low, high] = std::minmax(range.vmin, range.vmax);
  sample = std::clamp(sample, low, high);
  const std::uint32_t depth = range.vmin < range.vmax ? sample - range.vmin : range.vmin - sample;
  const std::uint32_t whole = high - low;
  const Wide twice = Wide{2} * depth * static_cast<std::uint64_t>(range.levels) + whole;
  return static_cast<std::int64_t>(twice / (Wide{2} * whole));
}

void portable::slice_u8(std::span<const std::span<std::byte>> layers, std::int64_t first_level,
                        std::span<const std::uint8_t> src, std::int64_t width, std::int64_t rows,
                        const SliceRange& range) {
  detail::slice_with<SliceLeaf>(layers, first_level, src, width, rows, range);
}

void portable::slice_u16(std::span<const std::span<std::byte>> layers, std::int64_t first_level,
                         std::span<const std::uint16_t> src, std::int64_t width, std::int64_t rows,
                         const SliceRange& range) {
  detail::slice_with<SliceLeaf>(layers, first_level, src, width, rows, range);
}

}  // namespace gravure::raster
