#include "raw_images.hpp"

#include <tiffio.h>
#include <zlib.h>

namespace gravure::test {
namespace {

std::string number(std::uint32_t value, int bytes, bool big_endian) {
  std::string text;
  for (int i = 0; i < bytes; ++i) {
    text += static_cast<char>(value >> (8 * (big_endian ? bytes - 1 - i : i)));
  }
  return text;
}

std::string little(std::uint32_t value, int bytes) {
  return number(value, bytes, false);
}

std::string big(std::uint32_t value) {
  return number(value, 4, true);
}

}  // namespace

std::string png_chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return big(static_cast<std::uint32_t>(data.size())) + body + big(static_cast<std::uint32_t>(sum));
}

std::string png_file(const RawPng& png) {
  std::string filtered;
  const std::size_t row_bytes = png.height == 0 ? 0 : png.rows.size() / png.height;
  for (std::size_t row = 0; row_bytes > 0 && row < png.height; ++row) {
    filtered += '\0' + png.rows.substr(row * row_bytes, row_bytes);
  }
  uLongf size = compressBound(static_cast<uLong>(filtered.size()));
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(filtered.data()),
           static_cast<uLong>(filtered.size()));
  packed.resize(size);
  std::string ihdr = big(png.width) + big(png.height);
  for (const int value : {png.depth, png.colour_type, 0, 0, png.interlace}) {
    ihdr += static_cast<char>(value);
  }
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", ihdr) + png.more_chunks + png_chunk("IDAT", packed) +
         png_chunk("IEND", "");
}

std::string bmp_file(const RawBmp& bmp) {
  std::string palette;
  for (const std::uint32_t colour : bmp.palette) {
    palette += little(colour, 4);
  }
  const auto offset = static_cast<std::uint32_t>(54 + palette.size());
  const auto data_size = static_cast<std::uint32_t>(bmp.data.size());
  return "BM" + little(offset + data_size, 4) + little(0, 4) + little(offset, 4) + little(40, 4) +
         little(static_cast<std::uint32_t>(bmp.width), 4) + little(static_cast<std::uint32_t>(bmp.height), 4) +
         little(1, 2) + little(static_cast<std::uint32_t>(bmp.bits), 2) + little(bmp.compression, 4) +
         little(data_size, 4) + little(125'000, 4) + little(100'000, 4) +
         little(static_cast<std::uint32_t>(bmp.palette.size()), 4) + little(0, 4) + palette + bmp.data;
}

void write_plain_tiff(const std::string& path, int bits, int samples, int photometric, int sample_format) {
  TIFF* const tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 16);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, sample_format);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, photometric);
  if (photometric == PHOTOMETRIC_PALETTE) {
    std::vector<std::uint16_t> map(65536);
    TIFFSetField(tiff, TIFFTAG_COLORMAP, map.data(), map.data(), map.data());
  }
  std::vector<std::byte> row(1024);
  TIFFWriteEncodedStrip(tiff, 0, row.data(), TIFFStripSize(tiff));
  TIFFClose(tiff);
}

}  // namespace gravure::test
