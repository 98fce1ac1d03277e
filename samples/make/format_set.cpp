#include "format_set.hpp"

namespace gravure::samples {
namespace {

std::string bits_name(Samples samples) {
  switch (samples) {
    case Samples::bit:
      return "1";
    case Samples::u8:
      return "8";
    case Samples::u16:
      return "16";
    case Samples::half:
      return "half";
    case Samples::f32:
      return "float";
  }
  return "";
}

FormatFile tiff(Samples samples, const std::string& compression, bool tiled) {
  FormatFile file;
  file.options.samples = samples;
  file.options.compression = compression;
  file.options.tiled = tiled;
  file.options.rows_per_strip = 16;
  file.name = "tiff_" + bits_name(samples) + "_" + compression + (tiled ? "_tiles" : "_strips") + ".tif";
  return file;
}

FormatFile other(const std::string& format, Samples samples, const std::string& extension) {
  FormatFile file;
  file.options.format = format;
  file.options.samples = samples;
  file.options.compression = format == "openexr" ? "zip" : "";
  file.name = format + "_" + bits_name(samples) + "." + extension;
  return file;
}

void add_tiff_files(std::vector<FormatFile>& files) {
  for (const Samples samples : {Samples::bit, Samples::u8, Samples::u16}) {
    for (const bool tiled : {false, true}) {
      for (const char* const compression : {"none", "packbits", "lzw", "zip"}) {
        files.push_back(tiff(samples, compression, tiled));
      }
    }
    if (samples == Samples::bit) {
      files.push_back(tiff(samples, "ccittfax4", false));
    }
    files.push_back(tiff(samples, "lzw", false));
    files.back().options.big_tiff = true;
    files.back().name = "bigtiff_" + bits_name(samples) + ".tif";
    files.push_back(tiff(samples, "zip", false));
    files.back().pages = 3;
    files.back().name = "tiff_" + bits_name(samples) + "_three_pages.tif";
  }
}

}  // namespace

std::vector<FormatFile> format_files() {
  std::vector<FormatFile> files;
  add_tiff_files(files);
  files.push_back(other("png", Samples::u8, "png"));
  files.push_back(other("png", Samples::u16, "png"));
  files.push_back(other("bmp", Samples::u8, "bmp"));
  files.push_back(other("pnm", Samples::u8, "pgm"));
  files.push_back(other("openexr", Samples::half, "exr"));
  files.push_back(other("openexr", Samples::f32, "exr"));
  files.push_back(other("openexr", Samples::f32, "exr"));
  files.back().options.tiled = true;
  files.back().name = "openexr_float_tiles.exr";
  files.push_back(other("openexr", Samples::half, "exr"));
  files.back().pages = 3;
  files.back().name = "openexr_half_three_parts.exr";
  return files;
}

bool format_pixel(std::int64_t x, std::int64_t y, std::int64_t page) {
  x += page;
  const std::int64_t dx = x - 60;
  const std::int64_t dy = y - 50;
  const std::int64_t r2 = dx * dx + dy * dy;
  const bool ring = r2 > 900 && r2 < 1600;
  const bool stripes = y > 110 && x % 7 < 3;
  const bool diagonal = x > 110 && (x - y + (x * y) % 5) % 31 < 9;
  return ring || stripes || diagonal;
}

RowSource format_page(std::int64_t page, std::int64_t width) {
  return [page, width](std::int64_t y, std::vector<std::uint16_t>& levels) {
    for (std::int64_t x = 0; x < width; ++x) {
      levels[static_cast<std::size_t>(x)] = format_pixel(x, y, page) ? 65535 : 0;
    }
  };
}

}  // namespace gravure::samples
