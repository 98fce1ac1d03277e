#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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

/// Fills row `y` of a picture.
using PngRows = std::function<Result<void>(std::int64_t y, std::span<std::byte> row)>;
/// Takes the next bytes of a file; false where they cannot be kept.
using PngBytes = std::function<bool(std::span<const std::byte>)>;

/// The same file row by row: of the picture, whose `pixels` stay empty, a few rows are held at a time. Fails as
/// encode_png() and `rows` do, with io where `bytes` does.
Result<void> write_png(const PngPicture& picture, const PngRows& rows, const PngBytes& bytes);

}  // namespace gravure
