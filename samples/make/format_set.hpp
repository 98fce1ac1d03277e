#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image_writer.hpp"

namespace gravure::samples {

/// One picture in one of the formats that are read.
struct FormatFile {
  std::string name;  ///< "tiff_1_ccittfax4_strips.tif"
  FileOptions options;
  int pages = 1;
};

inline constexpr std::int64_t kFormatWidth = 203;
inline constexpr std::int64_t kFormatHeight = 151;

std::vector<FormatFile> format_files();
/// White or black: a ring, stripes and a ragged diagonal, unlike its mirror images. Page p is shifted by p pixels.
bool format_pixel(std::int64_t x, std::int64_t y, std::int64_t page);
/// Row of page `page` as levels 0 and 65535.
RowSource format_page(std::int64_t page, std::int64_t width = kFormatWidth);

}  // namespace gravure::samples
