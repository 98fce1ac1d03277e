#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "gravure/formats/image_files.hpp"
#include "image_writer.hpp"
#include "raw_images.hpp"
#include "temp_folder.hpp"

namespace gravure::test {
namespace {

template <class T>
std::vector<T> read_samples(const std::string& path, SampleType expected) {
  const ImageFiles files;
  const auto source = files.open(path, 0);
  EXPECT_TRUE(source) << source.error().message;
  if (!source) {
    return {};
  }
  const ImageInfo& info = source.value()->info();
  EXPECT_EQ(info.samples, expected);
  std::vector<T> values(static_cast<std::size_t>(row_bytes(info.samples, info.width) * info.height) / sizeof(T));
  const auto done = source.value()->read_rows(0, info.height, std::as_writable_bytes(std::span(values)));
  EXPECT_TRUE(done) << done.error().message;
  return values;
}

/// Sample i of a 256 x 256 picture is i.
const samples::RowSource kEveryLevel = [](std::int64_t y, std::vector<std::uint16_t>& levels) {
  for (std::size_t x = 0; x < levels.size(); ++x) {
    levels[x] = static_cast<std::uint16_t>(static_cast<std::size_t>(y) * 256 + x);
  }
};

TEST(ImportedValues, KeepAll65536LevelsOf16Bits) {
  const TempFolder folder;
  samples::FileOptions options;
  options.samples = samples::Samples::u16;
  for (const char* const format : {"tiff", "png"}) {
    options.format = format;
    options.compression = "zip";
    const std::string path = folder / ("levels." + std::string(format));
    ASSERT_TRUE(samples::write_image(path, 256, 256, {kEveryLevel}, options));
    const auto values = read_samples<std::uint16_t>(path, SampleType::u16);
    ASSERT_EQ(values.size(), 65536U);
    for (std::size_t i = 0; i < values.size(); ++i) {
      ASSERT_EQ(values[i], i) << format;
    }
  }
}

TEST(ImportedValues, KeepAll256LevelsOf8Bits) {
  const TempFolder folder;
  samples::FileOptions options;
  options.samples = samples::Samples::u8;
  for (const char* const format : {"tiff", "png", "bmp", "pnm"}) {
    options.format = format;
    options.compression = "lzw";
    const std::string path = folder / ("levels." + std::string(format));
    ASSERT_TRUE(samples::write_image(path, 256, 256, {kEveryLevel}, options));
    const auto values = read_samples<std::uint8_t>(path, SampleType::u8);
    ASSERT_EQ(values.size(), 65536U);
    for (std::size_t i = 0; i < values.size(); ++i) {
      ASSERT_EQ(values[i], i / 257) << format;
    }
  }
}

TEST(ImportedValues, AreTurnedRoundWhereZeroIsWhite) {
  const TempFolder folder;
  for (const int tile : {0, 16}) {
    TIFF* const tiff = TIFFOpen((folder / "white.tif").c_str(), "w");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 16);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 16);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISWHITE);
    TIFFSetField(tiff, tile != 0 ? TIFFTAG_TILEWIDTH : TIFFTAG_ROWSPERSTRIP, 16);
    if (tile != 0) {
      TIFFSetField(tiff, TIFFTAG_TILELENGTH, tile);
    }
    std::vector<std::uint8_t> stored(256);
    for (std::size_t i = 0; i < stored.size(); ++i) {
      stored[i] = static_cast<std::uint8_t>(i);
    }
    ASSERT_EQ(tile != 0 ? TIFFWriteEncodedTile(tiff, 0, stored.data(), 256)
                        : TIFFWriteEncodedStrip(tiff, 0, stored.data(), 256),
              256);
    TIFFClose(tiff);
    const auto values = read_samples<std::uint8_t>(folder / "white.tif", SampleType::u8);
    ASSERT_EQ(values.size(), 256U);
    for (std::size_t i = 0; i < values.size(); ++i) {
      ASSERT_EQ(values[i], 255 - i) << (tile != 0 ? "tile" : "strip");
    }
  }
}

TEST(ImportedValues, OfBilevelPngAndBmpArePackedWithWhiteAsOne) {
  const TempFolder folder;
  RawPng png;
  png.rows = std::string("\xA5\x0F\xFF\x00", 4);
  put_file(folder / "a.png", png_file(png));
  const std::vector<std::uint8_t> expected = {0xA5, 0x0F, 0xFF, 0x00};
  EXPECT_EQ(read_samples<std::uint8_t>(folder / "a.png", SampleType::bit), expected);

  RawBmp bmp;
  bmp.data = std::string("\xFF\x00\0\0\xA5\x0F\0\0", 8);  // bottom row first
  put_file(folder / "a.bmp", bmp_file(bmp));
  EXPECT_EQ(read_samples<std::uint8_t>(folder / "a.bmp", SampleType::bit), expected);
  bmp.height = -2;
  bmp.data = std::string("\xA5\x0F\0\0\xFF\x00\0\0", 8);
  put_file(folder / "top.bmp", bmp_file(bmp));
  EXPECT_EQ(read_samples<std::uint8_t>(folder / "top.bmp", SampleType::bit), expected);
  bmp.palette = {0xFFFFFF, 0x000000};
  bmp.data = std::string("\x5A\xF0\0\0\x00\xFF\0\0", 8);
  put_file(folder / "inverse.bmp", bmp_file(bmp));
  EXPECT_EQ(read_samples<std::uint8_t>(folder / "inverse.bmp", SampleType::bit), expected);
}

TEST(ImportedValues, BringTheSizeTagAlong) {
  const TempFolder folder;
  RawPng png;
  png.rows = std::string(4, '\0');
  png.more_chunks = png_chunk("pHYs", std::string("\0\1\xE8\x48\0\1\x86\xA0\1", 9));  // 125000, 100000 a metre
  put_file(folder / "a.png", png_file(png));
  RawBmp bmp;
  bmp.data = std::string(8, '\0');
  put_file(folder / "a.bmp", bmp_file(bmp));
  samples::FileOptions options;
  options.samples = samples::Samples::u8;
  options.x_dots_per_mm = 125;
  options.y_dots_per_mm = 100;
  ASSERT_TRUE(samples::write_image(folder / "a.tif", 256, 256, {kEveryLevel}, options));
  const ImageFiles files;
  for (const char* const name : {"a.png", "a.bmp", "a.tif"}) {
    const auto source = files.open(folder / name, 0);
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_NEAR(source.value()->info().x_dots_per_mm.value(), 125, 0.001) << name;
    EXPECT_NEAR(source.value()->info().y_dots_per_mm.value(), 100, 0.001) << name;
  }
}

void write_exr(const std::string& path, const std::vector<float>& values, const OIIO::TypeDesc& type, int tile = 0) {
  OIIO::ImageSpec spec(8, static_cast<int>(values.size() / 8), 1, type);
  spec.channelnames = {"Z"};
  spec.tile_width = spec.tile_height = tile;
  const auto output = OIIO::ImageOutput::create("openexr");
  ASSERT_TRUE(output->open(path, spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeFloat, values.data()));
  ASSERT_TRUE(output->close());
}

TEST(ImportedValues, OfHalfAndFloatAreExact) {
  const TempFolder folder;
  std::vector<float> values(64);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<float>(i) / 64.0F - 0.25F;  // exact in half too
  }
  write_exr(folder / "half.exr", values, OIIO::TypeHalf);
  EXPECT_EQ(read_samples<float>(folder / "half.exr", SampleType::f32), values);
  values[5] = 0.1F;
  values[6] = std::numeric_limits<float>::max();
  values[7] = std::numeric_limits<float>::denorm_min();
  write_exr(folder / "float.exr", values, OIIO::TypeFloat);
  EXPECT_EQ(read_samples<float>(folder / "float.exr", SampleType::f32), values);
}

TEST(ImportedValues, ThatAreNoNumbersAreRefusedWithTheirPlace) {
  const TempFolder folder;
  const ImageFiles files;
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {std::nanf(""), -std::nanf(""), infinity, -infinity}) {
    for (const int tile : {0, 16}) {
      std::vector<float> values(320, 0.5F);
      values[8 * 37 + 3] = bad;
      write_exr(folder / "bad.exr", values, OIIO::TypeFloat, tile);
      const auto source = files.open(folder / "bad.exr", 0);
      ASSERT_TRUE(source) << source.error().message;
      std::vector<float> rows(320);
      const auto bytes = std::as_writable_bytes(std::span(rows));
      EXPECT_TRUE(source.value()->read_rows(0, 37, bytes)) << "the rows before it are good";
      const auto done = source.value()->read_rows(30, 10, bytes);
      ASSERT_FALSE(done);
      EXPECT_EQ(done.error().code, ErrorCode::bad_file);
      EXPECT_NE(done.error().message.find("row 37, column 3"), std::string::npos) << done.error().message;
    }
  }
}

/// A crop that kept its place: data and display window agree, but do not begin at 0.
TEST(ImportedValues, AreThoseOfAnOpenExrWhoseWindowDoesNotBeginAt0) {
  const TempFolder folder;
  const std::string path = folder / "crop.exr";
  for (const int tile : {0, 16}) {
    OIIO::ImageSpec spec(40, 24, 1, OIIO::TypeFloat);
    spec.x = spec.full_x = 7;
    spec.y = spec.full_y = -5;
    spec.full_width = spec.width;
    spec.full_height = spec.height;
    spec.tile_width = spec.tile_height = tile;
    spec.channelnames = {"Y"};
    std::vector<float> values(40 * 24);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<float>(i);
    }
    const auto output = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(output->open(path, spec)) << output->geterror();
    ASSERT_TRUE(output->write_image(OIIO::TypeFloat, values.data())) << output->geterror();
    output->close();
    EXPECT_EQ(read_samples<float>(path, SampleType::f32), values) << "tiles of " << tile;
  }
}

}  // namespace
}  // namespace gravure::test
