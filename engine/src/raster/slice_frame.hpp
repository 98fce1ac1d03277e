#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "gravure/raster/place.hpp"
#include "gravure/raster/slice.hpp"
#include "words.hpp"

/// Private to engine/raster: pieces and layers around what an instruction set compares.
///
/// A Leaf has for each sample type
///   prepare(Piece&, src, flip)    copies src ^ flip into the piece, in the order cut() wants, and finds its least and
///                                 greatest sample (of src ^ flip);
///   cut(dst, piece, limit)        bits where the sample is at least the limit; unused low bits 0.
namespace gravure::raster::detail {

inline constexpr std::int64_t kPieceSamples = 4096;

template <class Sample>
struct Piece {
  alignas(64) std::array<Sample, kPieceSamples> samples;
  std::int64_t size = 0;
  Sample least = 0;
  Sample greatest = 0;
};

/// All bits of `count` set to `one`, the unused low bits 0.
inline void fill_bits(std::byte* dst, std::int64_t count, bool one) {
  const std::int64_t bytes = packed_bytes(count);
  std::memset(dst, one ? 0xFF : 0, static_cast<std::size_t>(bytes));
  if (const int rest = static_cast<int>(count & 7); one && rest != 0) {
    dst[bytes - 1] = static_cast<std::byte>(top_bits(rest));
  }
}

/// Limits of the layers for samples ^ flip, where "at most t" has become "at least ~t".
template <class Sample>
std::vector<Sample> layer_limits(std::int64_t first_level, std::size_t count, const SliceRange& range, Sample flip) {
  std::vector<Sample> limits(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t limit =
        slice_threshold(first_level + static_cast<std::int64_t>(k), range.levels, range.vmin, range.vmax);
    limits[k] = static_cast<Sample>(limit ^ flip);
  }
  return limits;
}

template <class Leaf, class Sample>
void slice_with(std::span<const std::span<std::byte>> layers, std::int64_t first_level, std::span<const Sample> src,
                std::int64_t width, std::int64_t rows, const SliceRange& range) {
  constexpr Sample kMost = std::numeric_limits<Sample>::max();
  assert(width >= 0 && rows >= 0 && rows * width <= static_cast<std::int64_t>(src.size()));
  assert(range.vmin <= kMost && range.vmax <= kMost);
  const Sample flip = slice_where(range.vmin, range.vmax) == Where::at_least ? Sample{0} : kMost;
  const std::vector<Sample> limits = layer_limits<Sample>(first_level, layers.size(), range, flip);
  const std::int64_t stride = packed_bytes(width);
  Piece<Sample> piece;
  for (std::int64_t row = 0; row < rows; ++row) {
    for (std::int64_t x = 0; x < width; x += kPieceSamples) {
      piece.size = width - x < kPieceSamples ? width - x : kPieceSamples;
      Leaf::prepare(piece, src.data() + row * width + x, flip);
      for (std::size_t k = 0; k < limits.size(); ++k) {
        assert(rows * stride <= static_cast<std::int64_t>(layers[k].size()));
        std::byte* dst = layers[k].data() + row * stride + x / 8;
        if (limits[k] <= piece.least || limits[k] > piece.greatest) {
          fill_bits(dst, piece.size, limits[k] <= piece.least);
        } else {
          Leaf::cut(dst, piece, limits[k]);
        }
      }
    }
  }
}

}  // namespace gravure::raster::detail
