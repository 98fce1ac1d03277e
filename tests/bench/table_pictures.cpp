#include "table_step.hpp"

#include <tiffio.h>

#include <cmath>
#include <cstring>
#include <span>

namespace gravure::bench {
namespace {

constexpr std::size_t kRowBytes = (kWidth + 7) / 8;
constexpr std::int64_t kSlices = 10;
constexpr std::int64_t kStack = 10;

enum class Kind : std::uint8_t { sparse, dense, screened };

/// 0 to 1: floors, walls and what lies between them of hexagonal cells.
double cell(double x, double y) {
  constexpr double kPitch = 61.37;
  const double a = x / kPitch * 2 * M_PI;
  const double b = y / kPitch * 2 * M_PI / std::sqrt(3.0);
  return (std::cos(a) * std::cos(b) + 0.5 * std::cos(2 * b) + 0.75) / 2.25;
}

/// sparse: struts of a stent; dense: the walls of the cells; screened: the cells as a scattered dither.
Bytes draw(Kind kind) {
  Bytes bits(kRowBytes * kHeight);
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const double strut = std::fabs(std::remainder(x - 40 * std::sin(y / 90.0), 140.0));
      const bool one = kind == Kind::sparse  ? strut < 6
                       : kind == Kind::dense ? cell(x, y) > 0.38
                                             : cell(x, y) * 65536 > (noise(x, y) & 0xFFFFU);
      if (one) {
        bits[y * kRowBytes + x / 8] |= static_cast<std::byte>(0x80U >> (x % 8));
      }
    }
  }
  return bits;
}

struct Form {
  const char* name;
  int compression;
  std::uint32_t rows_per_strip = 64;
  bool tiles = false;
  const char* mode = "w";
};

void set_common(TIFF* tiff, const Form& form, int bits) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kWidth);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kHeight);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, form.compression);
}

constexpr std::uint32_t kTile = 256;

void write_tiled(TIFF* tiff, const Bytes& bits) {
  TIFFSetField(tiff, TIFFTAG_TILEWIDTH, kTile);
  TIFFSetField(tiff, TIFFTAG_TILELENGTH, kTile);
  Bytes tile(kTile / 8 * kTile);
  for (std::uint32_t y = 0; y < kHeight; y += kTile) {
    for (std::uint32_t x = 0; x < kWidth; x += kTile) {
      std::fill(tile.begin(), tile.end(), std::byte{0});
      for (std::uint32_t row = 0; row < std::min(kTile, kHeight - y); ++row) {
        const std::size_t bytes = std::min<std::size_t>(kTile / 8, kRowBytes - x / 8);
        std::memcpy(&tile[row * kTile / 8], &bits[(y + row) * kRowBytes + x / 8], bytes);
      }
      TIFFWriteTile(tiff, tile.data(), x, y, 0, 0);
    }
  }
}

void write_bits(const std::string& path, const Form& form, Bytes bits) {
  TIFF* tiff = TIFFOpen(path.c_str(), form.mode);
  set_common(tiff, form, 1);
  if (form.tiles) {
    write_tiled(tiff, bits);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, form.rows_per_strip);
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      TIFFWriteScanline(tiff, &bits[y * kRowBytes], y);
    }
  }
  TIFFClose(tiff);
}

template <class Sample>
void write_grey(const std::string& path, const Form& form) {
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  set_common(tiff, form, 8 * sizeof(Sample));
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, form.rows_per_strip);
  constexpr double kMost = sizeof(Sample) == 1 ? 255 : 65535;
  std::vector<Sample> row(kWidth);
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      row[x] = static_cast<Sample>(kMost * std::min(1.0, std::max(0.0, cell(x, y))));
    }
    TIFFWriteScanline(tiff, row.data(), y);
  }
  TIFFClose(tiff);
}

}  // namespace

void write_pictures(const std::filesystem::path& folder) {
  const std::pair<const char*, Kind> kinds[] = {
      {"sparse", Kind::sparse}, {"dense", Kind::dense}, {"screened", Kind::screened}};
  const Form strips[] = {{"none", COMPRESSION_NONE},
                         {"packbits", COMPRESSION_PACKBITS},
                         {"lzw", COMPRESSION_LZW},
                         {"deflate", COMPRESSION_ADOBE_DEFLATE},
                         {"g4", COMPRESSION_CCITTFAX4}};
  const Form others[] = {{"none-tiles", COMPRESSION_NONE, 0, true},
                         {"deflate-tiles", COMPRESSION_ADOBE_DEFLATE, 0, true},
                         {"g4-tiles", COMPRESSION_CCITTFAX4, 0, true},
                         {"none-bigtiff", COMPRESSION_NONE, 64, false, "w8"},
                         {"lzw-onestrip", COMPRESSION_LZW, kHeight}};
  for (const auto& [name, kind] : kinds) {
    const Bytes bits = draw(kind);
    for (const Form& form : strips) {
      write_bits((folder / (std::string(name) + "_" + form.name + ".tif")).string(), form, bits);
    }
    for (const Form& form : others) {
      if (kind == Kind::dense) {
        write_bits((folder / (std::string(name) + "_" + form.name + ".tif")).string(), form, bits);
      }
    }
  }
  write_grey<std::uint8_t>((folder / "grey8_none.tif").string(), {"none", COMPRESSION_NONE});
  write_grey<std::uint8_t>((folder / "grey8_deflate.tif").string(), {"deflate", COMPRESSION_ADOBE_DEFLATE});
  write_grey<std::uint16_t>((folder / "grey16_deflate.tif").string(), {"deflate", COMPRESSION_ADOBE_DEFLATE});
}

Picture picture_of(const std::string& file) {
  const std::string suffix = std::filesystem::path(file).extension().string();
  const bool turned = suffix == ".columns";
  const bool stack = suffix == ".stack";
  Picture picture;
  picture.path = turned || stack ? file.substr(0, file.size() - suffix.size()) : file;
  picture.repeats = stack ? kStack : 1;
  picture.width = kWidth;
  picture.height = kHeight;
  picture.along = turned ? LinesAlong::columns : LinesAlong::rows;
  const std::string name = std::filesystem::path(file).filename().string();
  picture.samples = name.starts_with("grey16")  ? SampleType::u16
                    : name.starts_with("grey8") ? SampleType::u8
                                                : SampleType::bit;
  picture.levels = name.starts_with("grey16") ? kSlices : 0;
  return picture;
}

void write_roller(const std::string& path) {
  constexpr std::uint32_t kAcross = 200'000;
  constexpr std::uint32_t kAround = 188'496;
  constexpr std::uint32_t kRows = 64;
  constexpr std::size_t kBytes = kAcross / 8;
  constexpr std::size_t kWhole = kWidth / 8;  // of a row of the cells
  const Bytes cells = draw(Kind::dense);
  TIFF* tiff = TIFFOpen(path.c_str(), "w8");
  if (tiff == nullptr) {
    stop(path + ": cannot write");
  }
  set_common(tiff, {"none", COMPRESSION_NONE}, 1);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kAcross);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kAround);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, kRows);
  Bytes strip(kBytes * kRows);
  for (std::uint32_t y = 0; y < kAround; y += kRows) {
    const std::uint32_t rows = std::min(kRows, kAround - y);
    for (std::uint32_t row = 0; row < rows; ++row) {
      const std::byte* from = &cells[(y + row) % kHeight * kRowBytes];
      for (std::size_t at = 0; at < kBytes; at += kWhole) {
        std::memcpy(&strip[row * kBytes + at], from, std::min(kWhole, kBytes - at));
      }
    }
    if (TIFFWriteEncodedStrip(tiff, y / kRows, strip.data(), static_cast<tmsize_t>(rows * kBytes)) < 0) {
      stop(path + ": cannot write");
    }
  }
  TIFFClose(tiff);
}

}  // namespace gravure::bench
