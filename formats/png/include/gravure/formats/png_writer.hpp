#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "gravure/core/error.hpp"

namespace gravure {

/// A picture of 8 bits a sample, rows without padding: grey (1 sample a pixel) or red, green, blue (3).
struct PngPicture {
  std::int64_t width = 0;   ///< pixels, 1 .. kMostPngSide
  std::int64_t height = 0;  ///< rows, likewise
  int samples = 1;          ///< 1 or 3
  std::span<const std::byte> pixels;
};
inline constexpr std::int64_t kMostPngSide = 16'384;

/// The picture as a PNG file; the same pixels give the same bytes. Fails with out_of_range on sizes, bad_argument where
/// `pixels` has another size.
Result<std::string> encode_png(const PngPicture& picture);

}  // namespace gravure
