#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::samples {

enum class Samples : std::uint8_t { bit, u8, u16, half, f32 };

/// How a file is written. The same options and rows give the same bytes: no date, no host name goes in.
struct FileOptions {
  std::string format = "tiff";  ///< OpenImageIO's name: "tiff", "png", "bmp", "openexr", "pnm" (grey only: its PBM has
                                ///< black and white exchanged)
  Samples samples = Samples::bit;
  std::string compression = "none";  ///< "none", "packbits", "lzw", "zip"; "ccittfax4": bits in strips
  bool tiled = false;                ///< in tiles of 64 x 64
  bool big_tiff = false;
  int rows_per_strip = 64;
  double x_dots_per_mm = 0;  ///< 0: no size tag
  double y_dots_per_mm = 0;
};

/// Gives row `y` as levels from 0 (black) to 65535 (white), `width` of them. Bits are white from 32768 on.
using RowSource = std::function<void(std::int64_t y, std::vector<std::uint16_t>& levels)>;

/// Writes one page after the other of equal size; the file appears whole or not at all. Fails with io.
Result<void> write_image(const std::string& path, std::int64_t width, std::int64_t height,
                         const std::vector<RowSource>& pages, const FileOptions& options);

}  // namespace gravure::samples
