#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gravure::test {

/// A PNG put together by hand: what OpenImageIO would not write.
struct RawPng {
  std::uint32_t width = 16;
  std::uint32_t height = 2;
  int depth = 1;
  int colour_type = 0;
  int interlace = 0;
  std::string rows;         ///< without the filter bytes, all rows; cut into `height` equal parts
  std::string more_chunks;  ///< before the data
};
std::string png_chunk(const std::string& type, const std::string& data);
std::string png_file(const RawPng& png);

/// An uncompressed BMP put together by hand.
struct RawBmp {
  std::int32_t width = 16;
  std::int32_t height = 2;  ///< negative: top row first
  int bits = 1;
  std::uint32_t compression = 0;
  std::vector<std::uint32_t> palette = {0x000000, 0xFFFFFF};
  std::string data;  ///< rows padded to 4 bytes, bottom row first
};
std::string bmp_file(const RawBmp& bmp);

/// A colour, grey or palette TIFF of one black row of 16 pixels.
void write_plain_tiff(const std::string& path, int bits, int samples, int photometric, int sample_format = 1);

}  // namespace gravure::test
