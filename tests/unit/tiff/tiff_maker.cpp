#include "tiff_maker.hpp"

#include <tiffio.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <random>

namespace gravure::test {
namespace {

void must(bool done, const char* what) {
  if (!done) {
    std::fprintf(stderr, "test file: %s failed\n", what);
    std::abort();
  }
}

void put_number(std::string& out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) {
    out += static_cast<char>(value >> (8 * i));
  }
}

void set_tags(TIFF* tiff, const Bits& bits, const TiffSpec& spec) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(bits.width));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(bits.height));
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, spec.compression);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, spec.photometric);
  TIFFSetField(tiff, TIFFTAG_FILLORDER, spec.fill_order);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, spec.orientation);
  if (spec.compression == COMPRESSION_CCITTFAX3) {
    TIFFSetField(tiff, TIFFTAG_GROUP3OPTIONS, spec.group3_options);
  }
  if (spec.tile_width != 0) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, spec.tile_width);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, spec.rows_per_block);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, spec.rows_per_block);
  }
  if (spec.x_dots > 0) {
    TIFFSetField(tiff, TIFFTAG_XRESOLUTION, spec.x_dots);
    TIFFSetField(tiff, TIFFTAG_YRESOLUTION, spec.y_dots);
    TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, spec.unit);
  }
}

void write_strips(TIFF* tiff, const Bits& bits, const TiffSpec& spec) {
  std::vector<std::uint32_t> strips(static_cast<std::size_t>((bits.height - 1) / spec.rows_per_block + 1));
  std::iota(strips.begin(), strips.end(), 0U);
  for (std::size_t i = 1; spec.strips_swapped && i + 1 < strips.size(); i += 3) {
    std::swap(strips[i], strips[i + 1]);
  }
  for (const std::uint32_t strip : strips) {
    const std::int64_t row = std::int64_t{strip} * spec.rows_per_block;
    const std::int64_t rows = std::min<std::int64_t>(spec.rows_per_block, bits.height - row);
    const auto from = bits.bytes.begin() + row * bits.row_size();
    std::vector<std::byte> copy(from, from + rows * bits.row_size());  // libtiff may reverse bits in place
    must(TIFFWriteEncodedStrip(tiff, strip, copy.data(), static_cast<tmsize_t>(copy.size())) ==
             static_cast<tmsize_t>(copy.size()),
         "strip");
  }
}

void write_tiles(TIFF* tiff, const Bits& bits, const TiffSpec& spec) {
  const std::int64_t tile_bytes = spec.tile_width / 8;
  std::uint32_t number = 0;
  for (std::int64_t row = 0; row < bits.height; row += spec.rows_per_block) {
    for (std::int64_t left = 0; left < bits.row_size(); left += tile_bytes, ++number) {
      std::vector<std::byte> tile(static_cast<std::size_t>(tile_bytes * spec.rows_per_block));
      for (std::int64_t y = row; y < std::min<std::int64_t>(bits.height, row + spec.rows_per_block); ++y) {
        const std::int64_t count = std::min(tile_bytes, bits.row_size() - left);
        std::memcpy(tile.data() + (y - row) * tile_bytes, bits.bytes.data() + y * bits.row_size() + left,
                    static_cast<std::size_t>(count));
      }
      const auto size = static_cast<tmsize_t>(tile.size());
      must(TIFFWriteEncodedTile(tiff, number, tile.data(), size) == size, "tile");
    }
  }
}

}  // namespace

Bits without_padding(Bits bits) {
  const auto unused = static_cast<unsigned>(bits.row_size() * 8 - bits.width);
  for (std::int64_t row = 1; row <= bits.height; ++row) {
    bits.bytes[static_cast<std::size_t>(row * bits.row_size() - 1)] &= static_cast<std::byte>(0xFFU << unused);
  }
  return bits;
}

Bits pattern(std::int64_t width, std::int64_t height, std::uint32_t seed) {
  Bits bits{width, height, std::vector<std::byte>(static_cast<std::size_t>((width + 7) / 8 * height))};
  std::mt19937 rng(seed);
  for (std::int64_t y = 0; y < height; ++y) {
    for (std::int64_t x = 0; x < width; ++x) {
      const bool runs = ((x / 13 + y / 7) & 1) != 0;
      const bool noise = y % 5 == 4 && (rng() & 4U) != 0;
      if (runs != noise) {
        bits.bytes[static_cast<std::size_t>(y * bits.row_size() + x / 8)] |=
            static_cast<std::byte>(0x80U >> static_cast<unsigned>(x % 8));
      }
    }
  }
  return bits;
}

std::string codec_name(std::uint16_t compression) {
  const TIFFCodec* const codec = TIFFFindCODEC(compression);
  return codec != nullptr ? codec->name : std::to_string(compression);
}

void write_tiff(const std::string& path, const std::vector<Bits>& pages, const TiffSpec& spec) {
  const TIFFErrorHandler printing = TIFFSetWarningHandler(nullptr);  // it objects to the old Deflate number
  TIFF* const tiff = TIFFOpen(path.c_str(), spec.mode.c_str());
  must(tiff != nullptr, "open");
  for (const Bits& bits : pages) {
    set_tags(tiff, bits, spec);
    spec.tile_width != 0 ? write_tiles(tiff, bits, spec) : write_strips(tiff, bits, spec);
    must(TIFFWriteDirectory(tiff) == 1, "directory");
  }
  TIFFClose(tiff);
  TIFFSetWarningHandler(printing);
}

std::uint32_t raw_data_offset(std::size_t tag_count) {
  return static_cast<std::uint32_t>(8 + 2 + 12 * tag_count + 4);
}

std::string raw_tiff(const std::vector<RawTag>& tags, const std::string& data, std::uint32_t next) {
  std::string file("II\x2a\0\x08\0\0\0", 8);
  put_number(file, static_cast<std::uint32_t>(tags.size()), 2);
  for (const RawTag& tag : tags) {
    put_number(file, tag.tag, 2);
    put_number(file, tag.type, 2);
    put_number(file, tag.count, 4);
    put_number(file, tag.value, 4);
  }
  put_number(file, next, 4);
  return file + data;
}

std::vector<RawTag> bilevel_tags(std::uint32_t width, std::uint32_t height, std::uint32_t offset, std::uint32_t bytes) {
  return {{256, 4, 1, width},  {257, 4, 1, height}, {258, 3, 1, 1},      {259, 3, 1, 1},    {262, 3, 1, 1},
          {273, 4, 1, offset}, {277, 3, 1, 1},      {278, 4, 1, height}, {279, 4, 1, bytes}};
}

Result<Bits> read_all(ImageSource& source) {
  const ImageInfo& info = source.info();
  Bits bits{info.width, info.height,
            std::vector<std::byte>(static_cast<std::size_t>((info.width + 7) / 8 * info.height))};
  GRAVURE_CHECK(source.read_rows(0, info.height, bits.bytes));
  return without_padding(std::move(bits));
}

}  // namespace gravure::test
