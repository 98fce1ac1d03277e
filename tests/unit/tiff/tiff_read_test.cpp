#include <gtest/gtest.h>
#include <tiffio.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "gravure/formats/tiff.hpp"
#include "gravure/formats/tiff_writer.hpp"
#include "temp_folder.hpp"
#include "tiff_maker.hpp"

namespace gravure::test {
namespace {

struct Variant {
  std::string name;
  TiffSpec spec;
};

/// Every codec x strips, one strip, tiles x fill order x polarity x byte order.
std::vector<Variant> variants() {
  std::vector<Variant> all;
  for (const std::uint16_t compression : {kNone, kPackBits, kLzw, kDeflate, kOldDeflate, kG4, kG3, kZstd}) {
    for (const std::uint32_t tile_width : {0U, 16U, 64U}) {
      for (const std::uint16_t fill_order : {std::uint16_t{FILLORDER_MSB2LSB}, std::uint16_t{FILLORDER_LSB2MSB}}) {
        for (const char* const mode : {"wl", "wb", "w8"}) {
          TiffSpec spec;
          spec.compression = compression;
          spec.fill_order = fill_order;
          spec.tile_width = tile_width;
          spec.mode = mode;
          spec.photometric = fill_order == FILLORDER_MSB2LSB ? PHOTOMETRIC_MINISWHITE : PHOTOMETRIC_MINISBLACK;
          all.push_back({codec_name(compression) + (tile_width == 0 ? " strips" : " tiles") + " fill " +
                             std::to_string(fill_order) + " " + mode,
                         spec});
        }
      }
    }
  }
  return all;
}

/// libtiff's decoder of JBIG turns the bits of what it is given round, and leaves them so.
TEST(BilevelTiff, ReadsAStripAgainWhoseDecoderWritesToItsInput) {
  if (TIFFIsCODECConfigured(COMPRESSION_JBIG) == 0) {
    GTEST_SKIP() << "this libtiff has no JBIG";
  }
  const TempFolder folder;
  const Bits bits = pattern(203, 75);
  TiffSpec spec;
  spec.compression = COMPRESSION_JBIG;
  spec.rows_per_block = 75;
  write_tiff(folder / "a.tif", {bits}, spec);
  const auto source = BilevelTiffOpener().open(folder / "a.tif", 0);
  ASSERT_TRUE(source) << source.error().message;
  for (int time = 0; time < 3; ++time) {
    const auto read = read_all(*source.value());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read.value(), bits);
  }
}

TEST(BilevelTiff, ReadsEveryCodecLayoutAndByteOrderAsWritten) {
  const TempFolder folder;
  const std::string path = folder / "a.tif";
  const BilevelTiffOpener opener;
  for (const Variant& variant : variants()) {
    SCOPED_TRACE(variant.name);
    const Bits bits = pattern(203, 75);
    write_tiff(path, {bits}, variant.spec);
    const auto source = opener.open(path, 0);
    ASSERT_TRUE(source) << source.error().message;
    const ImageInfo& info = source.value()->info();
    EXPECT_EQ(info.path, path);
    EXPECT_EQ(info.page, 0);
    EXPECT_EQ(info.samples, SampleType::bit);
    EXPECT_EQ(info.zero_is_white, variant.spec.photometric == PHOTOMETRIC_MINISWHITE);
    EXPECT_EQ(info.rows_per_block, 16);
    EXPECT_TRUE(info.random_access);
    const auto read = read_all(*source.value());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read.value(), bits);
  }
}

TEST(BilevelTiff, ReadsTwoDimensionalGroup3) {
  const TempFolder folder;
  const Bits bits = pattern(300, 40);
  TiffSpec spec;
  spec.compression = kG3;
  spec.group3_options = GROUP3OPT_2DENCODING;
  write_tiff(folder / "g3.tif", {bits}, spec);
  const auto source = BilevelTiffOpener().open(folder / "g3.tif", 0);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ(read_all(*source.value()).value(), bits);
}

TEST(BilevelTiff, ReadsAnyWidthDownToOnePixel) {
  const TempFolder folder;
  const BilevelTiffOpener opener;
  for (std::int64_t width = 1; width <= 40; ++width) {
    for (const std::uint32_t tile_width : {0U, 16U}) {
      const Bits bits = pattern(width, 5);
      TiffSpec spec;
      spec.compression = kG4;
      spec.tile_width = tile_width;
      write_tiff(folder / "w.tif", {bits}, spec);
      const auto source = opener.open(folder / "w.tif", 0);
      ASSERT_TRUE(source) << source.error().message;
      EXPECT_EQ(read_all(*source.value()).value(), bits) << width;
    }
  }
}

/// The rows asked for are those of `bits`.
void expect_rows(ImageSource& source, const Bits& bits, std::int64_t first, std::int64_t count) {
  Bits part{bits.width, count, std::vector<std::byte>(static_cast<std::size_t>(count * bits.row_size()))};
  const auto done = source.read_rows(first, count, part.bytes);
  ASSERT_TRUE(done) << done.error().message;
  part = without_padding(std::move(part));
  const auto from = bits.bytes.begin() + first * bits.row_size();
  ASSERT_TRUE(std::equal(part.bytes.begin(), part.bytes.end(), from)) << first << " + " << count;
}

TEST(BilevelTiff, GivesTheSameRowsInPartsAsWhole) {
  const std::uint32_t seed = image_test_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  std::mt19937 rng(seed);
  const TempFolder folder;
  const Bits bits = pattern(333, 101);
  std::vector<TiffSpec> specs(4);
  specs[0].compression = kLzw;
  specs[1].compression = kLzw;
  specs[1].tile_width = 32;
  specs[2].compression = kNone;
  specs[3].compression = kNone;
  specs[3].strips_swapped = true;
  for (const TiffSpec& spec : specs) {
    SCOPED_TRACE(testing::Message() << "specification " << &spec - specs.data());
    write_tiff(folder / "p.tif", {bits}, spec);
    const auto source = BilevelTiffOpener().open(folder / "p.tif", 0);
    ASSERT_TRUE(source) << source.error().message;
    for (int trial = 0; trial < 500; ++trial) {
      const auto first = static_cast<std::int64_t>(rng() % static_cast<std::uint64_t>(bits.height));
      const auto most = static_cast<std::uint64_t>(bits.height - first);
      const auto count = static_cast<std::int64_t>(trial == 0 ? most : rng() % (most + 1));
      ASSERT_NO_FATAL_FAILURE(expect_rows(*source.value(), bits, first, count));
    }
  }
}

TEST(BilevelTiff, PutsTilesOfEveryWidthIntoRows) {
  const TempFolder folder;
  const Bits bits = pattern(1100, 150);
  for (const std::uint16_t compression : {kNone, kLzw, kDeflate}) {
    for (const std::uint32_t tile_width : {48U, 128U, 256U, 512U, 1024U, 2048U}) {
      SCOPED_TRACE(codec_name(compression) + " tiles of " + std::to_string(tile_width));
      TiffSpec spec;
      spec.compression = compression;
      spec.tile_width = tile_width;
      spec.rows_per_block = 80;
      spec.fill_order = FILLORDER_LSB2MSB;
      write_tiff(folder / "t.tif", {bits}, spec);
      const auto source = BilevelTiffOpener().open(folder / "t.tif", 0);
      ASSERT_TRUE(source) << source.error().message;
      for (const std::int64_t first : {0, 1, 79, 80, 149, 3}) {
        expect_rows(*source.value(), bits, first, bits.height - first);
        expect_rows(*source.value(), bits, first, 1);
      }
    }
  }
}

TEST(BilevelTiff, ReadsBlocksThatAreLargeOrStoredInAnotherOrder) {
  const std::uint32_t seed = image_test_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  std::mt19937 rng(seed);
  const TempFolder folder;
  const std::string path = folder / "r.tif";
  constexpr std::uint32_t kRows = 100;
  constexpr std::uint32_t kStrips = 5;
  Bits bits{16384, kRows * kStrips, std::vector<std::byte>(std::size_t{2048} * kRows * kStrips)};
  for (std::size_t i = 0; i < bits.bytes.size(); ++i) {  // every other strip does not shrink: 200 KiB as stored
    const bool noise = i / (2048 * kRows) % 2 == 1;
    bits.bytes[i] = static_cast<std::byte>(noise ? rng() >> 8U : i / 100);
  }
  TIFF* const tiff = TIFFOpen(path.c_str(), "w");
  ASSERT_NE(tiff, nullptr);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 16384);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kRows * kStrips);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, kDeflate);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, kRows);
  for (const std::uint32_t strip : {3U, 4U, 0U, 2U, 1U}) {
    std::byte* const from = &bits.bytes[std::size_t{2048} * kRows * strip];
    ASSERT_GT(TIFFWriteEncodedStrip(tiff, strip, from, 2048 * kRows), 0);
  }
  TIFFClose(tiff);
  const auto source = BilevelTiffOpener().open(path, 0);
  ASSERT_TRUE(source) << source.error().message;
  for (const std::int64_t first : {0, 320, 50, 450, 199}) {
    expect_rows(*source.value(), bits, first, bits.height - first);
    expect_rows(*source.value(), bits, first, 10);
  }
}

TEST(BilevelTiff, ReadsLargeStripsUpwardsBackwardsAndWithRowsLeftOut) {
  const TempFolder folder;
  const std::string path = folder / "large.tif";
  const Bits bits = pattern(8003, 2700);
  for (const std::uint16_t compression : {kPackBits, kLzw, kDeflate, kG4, kG3, kZstd}) {
    for (const std::uint32_t rows : {1100U, 2700U}) {  // more than a MiB each
      SCOPED_TRACE(codec_name(compression) + " strips of " + std::to_string(rows));
      TiffSpec spec;
      spec.compression = compression;
      spec.rows_per_block = rows;
      write_tiff(path, {bits}, spec);
      const auto opened = BilevelTiffOpener().open(path, 0);
      ASSERT_TRUE(opened) << opened.error().message;
      ImageSource& source = *opened.value();
      EXPECT_TRUE(source.info().random_access);
      EXPECT_EQ(source.info().rows_per_block, rows);
      EXPECT_GE(source.info().decoder_bytes, rows * bits.row_size());
      expect_rows(source, bits, 0, 70);
      expect_rows(source, bits, 70, 1);
      expect_rows(source, bits, 1000, 200);
      expect_rows(source, bits, 2400, 300);  // a strip passed over
      expect_rows(source, bits, 1090, 20);
      expect_rows(source, bits, 0, 2700);
      const auto upwards = BilevelTiffOpener().open(path, 0);
      expect_rows(*upwards.value(), bits, 0, 2700);
      expect_rows(*upwards.value(), bits, 0, 2700);
    }
  }
}

TEST(BilevelTiff, TellsTheDamagedRowOfALargeStripAndRefusesItBackwardsToo) {
  const TempFolder folder;
  const std::string path = folder / "damaged.tif";
  const Bits bits = pattern(8003, 1100);
  TiffSpec spec;
  spec.compression = kG4;
  spec.rows_per_block = 1100;
  write_tiff(path, {bits}, spec);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(path) / 2));
  file.write("\0\0\0\0\0\0\0\0", 8);
  file.close();
  const auto opened = BilevelTiffOpener().open(path, 0);
  ASSERT_TRUE(opened) << opened.error().message;
  ImageSource& source = *opened.value();
  expect_rows(source, bits, 0, 64);
  std::vector<std::byte> rows(bits.bytes.size());
  const auto upwards = source.read_rows(64, 1036, rows);
  ASSERT_FALSE(upwards);
  EXPECT_EQ(upwards.error().code, ErrorCode::bad_file);
  EXPECT_EQ(upwards.error().message.find("row 0:"), std::string::npos) << upwards.error().message;
  const auto whole = source.read_rows(0, 1100, rows);
  ASSERT_FALSE(whole);
  EXPECT_EQ(whole.error().code, ErrorCode::bad_file);
}

TEST(BilevelTiff, ReadsAThousandPagesInAnyOrder) {
  const TempFolder folder;
  const std::string path = folder / "pages.tif";
  std::vector<Bits> pages;
  for (std::uint32_t page = 0; page < 1000; ++page) {
    pages.push_back(pattern(65, 3, page));
  }
  write_tiff(path, pages, {});
  const BilevelTiffOpener opener;
  EXPECT_EQ(opener.count_pages(path).value(), 1000);
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const std::size_t page = i * 617 % pages.size();
    const auto source = opener.open(path, static_cast<std::int64_t>(page));
    ASSERT_TRUE(source) << source.error().message;
    ASSERT_EQ(read_all(*source.value()).value(), pages[page]) << page;
  }
}

TEST(BilevelTiff, NoticesThatAFileWasRewritten) {
  const TempFolder folder;
  const BilevelTiffOpener opener;
  write_tiff(folder / "x.tif", {pattern(8, 8), pattern(8, 8)}, {});
  EXPECT_EQ(opener.count_pages(folder / "x.tif").value(), 2);
  write_tiff(folder / "x.tif", {pattern(8, 8), pattern(8, 8), pattern(8, 8)}, {});
  EXPECT_EQ(opener.count_pages(folder / "x.tif").value(), 3);
}

TEST(BilevelTiff, TakesTheSizeTagInInchesAndCentimetres) {
  const TempFolder folder;
  TiffSpec spec;
  spec.x_dots = 254;
  spec.y_dots = 508;
  write_tiff(folder / "inch.tif", {pattern(8, 8)}, spec);
  const auto inch = BilevelTiffOpener().open(folder / "inch.tif", 0);
  EXPECT_NEAR(inch.value()->info().x_dots_per_mm.value(), 10, 1e-6);
  EXPECT_NEAR(inch.value()->info().y_dots_per_mm.value(), 20, 1e-6);
  spec.unit = RESUNIT_CENTIMETER;
  write_tiff(folder / "cm.tif", {pattern(8, 8)}, spec);
  EXPECT_NEAR(BilevelTiffOpener().open(folder / "cm.tif", 0).value()->info().x_dots_per_mm.value(), 25.4, 1e-6);
  spec.unit = RESUNIT_NONE;
  write_tiff(folder / "none.tif", {pattern(8, 8)}, spec);
  EXPECT_FALSE(BilevelTiffOpener().open(folder / "none.tif", 0).value()->info().x_dots_per_mm.has_value());
}

TEST(BilevelTiff, StreamsOneStripTooLargeToDecodeWhole) {
  const TempFolder folder;
  const std::string path = folder / "giant.tif";
  constexpr std::int64_t kWidth = std::int64_t{1} << 19;
  constexpr std::int64_t kHeight = kMaxTiffStripBytes / (kWidth / 8) + 3;
  TIFF* const tiff = TIFFOpen(path.c_str(), "w");
  ASSERT_NE(tiff, nullptr);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(kWidth));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(kHeight));
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, kG4);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(kHeight));
  std::vector<std::byte> row(kWidth / 8);
  for (std::int64_t y = 0; y < kHeight; ++y) {
    row[static_cast<std::size_t>(y)] = std::byte{0x5A};
    ASSERT_EQ(TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y), 0), 1);
    row[static_cast<std::size_t>(y)] = std::byte{0};
  }
  TIFFClose(tiff);

  const auto opened = BilevelTiffOpener().open(path, 0);
  ASSERT_TRUE(opened) << opened.error().message;
  ImageSource& source = *opened.value();
  EXPECT_FALSE(source.info().random_access);
  const auto expect_row = [&](std::int64_t y) {
    const auto done = source.read_rows(y, 1, row);
    ASSERT_TRUE(done) << done.error().message;
    for (std::int64_t i = 0; i < kWidth / 8; ++i) {
      ASSERT_EQ(row[static_cast<std::size_t>(i)], std::byte{i == y ? std::uint8_t{0x5A} : std::uint8_t{0}}) << y;
    }
  };
  expect_row(0);
  expect_row(1);
  expect_row(kHeight - 1);  // upwards, with rows left out
  const auto back = source.read_rows(5, 1, row);
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().code, ErrorCode::bad_argument);
  EXPECT_NE(back.error().message.find("row 5 asked for after row"), std::string::npos) << back.error().message;
  expect_row(0);  // from the start again
  expect_row(200);
}

TEST(BilevelTiff, TellsFaxDataThatAreLargerThanTheBits) {
  const TempFolder folder;
  const std::string path = folder / "a.tif";
  Bits dithered{256, 64, std::vector<std::byte>(32 * 64, std::byte{0x55})};
  for (std::size_t i = 0; i < dithered.bytes.size(); ++i) {
    dithered.bytes[i] = (i / 32 & 1) != 0 ? std::byte{0x5A} : std::byte{0xA5};
  }
  Bits blank{256, 64, std::vector<std::byte>(32 * 64)};
  for (const std::uint16_t codec : {kG3, kG4, kLzw, kNone}) {
    TiffSpec spec;
    spec.compression = codec;
    spec.rows_per_block = 64;
    write_tiff(path, {dithered, blank}, spec);
    const bool fax = codec == kG3 || codec == kG4;
    EXPECT_EQ(BilevelTiffOpener().open(path, 0).value()->info().fax_larger_than_raw, fax) << codec_name(codec);
    EXPECT_FALSE(BilevelTiffOpener().open(path, 1).value()->info().fax_larger_than_raw) << codec_name(codec);
  }
}

TEST(BilevelTiff, ReadsGiantUncompressedStripsInAnyOrder) {
  const TempFolder folder;
  const std::string path = folder / "two.tif";
  constexpr std::uint32_t kWidth = 1U << 19;
  constexpr std::uint32_t kRows = static_cast<std::uint32_t>(kMaxTiffBlockBytes / (kWidth / 8)) + 1;
  constexpr std::uint32_t kStrip = kRows * (kWidth / 8);
  const std::uint32_t data = raw_data_offset(9) + 16;
  std::vector<RawTag> tags = bilevel_tags(kWidth, 2 * kRows, 0, 0);
  tags[5] = {273, 4, 2, raw_data_offset(9)};
  tags[7].value = kRows;
  tags[8] = {279, 4, 2, raw_data_offset(9) + 8};
  std::string arrays;
  for (const std::uint32_t number : {data, data + kStrip, kStrip, kStrip}) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
      arrays += static_cast<char>(number >> shift);
    }
  }
  put_file(path, raw_tiff(tags, arrays));
  std::filesystem::resize_file(path, std::uintmax_t{data} + 2 * std::uintmax_t{kStrip});  // sparse zeros
  const auto mark = [&](std::int64_t y) {  // each row begins with its number
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(data + y * (kWidth / 8));
    file.write(reinterpret_cast<const char*>(&y), sizeof y);
  };
  const auto source = BilevelTiffOpener().open(path, 0);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_TRUE(source.value()->info().random_access);
  std::vector<std::byte> row(kWidth / 8, std::byte{1});
  EXPECT_LT(source.value()->info().decoder_bytes, 1 << 20) << "no strip is held";
  for (const std::int64_t y : {std::int64_t{2} * kRows - 1, std::int64_t{0}, std::int64_t{kRows}, std::int64_t{5}}) {
    mark(y);
    ASSERT_TRUE(source.value()->read_rows(y, 1, row));
    EXPECT_EQ(std::memcmp(row.data(), &y, sizeof y), 0) << y;
    EXPECT_EQ(row.back(), std::byte{0});
  }
}

}  // namespace
}  // namespace gravure::test
