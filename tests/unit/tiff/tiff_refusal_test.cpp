#include <fcntl.h>
#include <gtest/gtest.h>
#include <tiffio.h>
#include <unistd.h>

#include <filesystem>
#include <random>

#include "gravure/formats/tiff.hpp"
#include "temp_folder.hpp"
#include "tiff_maker.hpp"

namespace gravure::test {
namespace {

/// Opens page 0 and reads all of it.
Result<Bits> open_and_read(const std::string& path) {
  const BilevelTiffOpener opener;
  GRAVURE_TRY(const auto source, opener.open(path, 0));
  return read_all(*source);
}

void expect_refused(const std::string& path, const std::string& words, ErrorCode code = ErrorCode::bad_file) {
  const auto read = open_and_read(path);
  ASSERT_FALSE(read) << words;
  EXPECT_EQ(read.error().code, code) << read.error().message;
  EXPECT_NE(read.error().message.find(words), std::string::npos) << read.error().message;
  EXPECT_EQ(read.error().message.rfind(path, 0), 0U) << "the path comes first: " << read.error().message;
}

TEST(BilevelTiffRefuses, MissingFilesFoldersAndOtherThings) {
  const TempFolder folder;
  expect_refused(folder / "none.tif", "No such file");
  expect_refused(folder.path(), "is a folder");
  expect_refused("/dev/null", "is no regular file");
  put_file(folder / "empty.tif", "");
  expect_refused(folder / "empty.tif", "is not a TIFF file");
  put_file(folder / "text.tif", "these are no pixels");
  expect_refused(folder / "text.tif", "is not a TIFF file");
  put_file(folder / "short.tif", std::string("II\x2a\0\x08\0\0", 7));
  expect_refused(folder / "short.tif", "is not a TIFF file");
  put_file(folder / "unfinished.tif", std::string("II\x2a\0\0\0\0\0", 8));
  expect_refused(folder / "unfinished.tif", "its directory was never written");
}

/// Reading the descriptors of `path` fails from now on as on a broken disk: no process has memory at its lowest
/// addresses.
void break_disk(const std::string& path) {
  const int broken = ::open("/proc/self/mem", O_RDONLY | O_CLOEXEC);
  ASSERT_GE(broken, 0);
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    if (std::filesystem::read_symlink(entry.path(), failed) == path) {
      ASSERT_GE(::dup3(broken, std::stoi(entry.path().filename().string()), O_CLOEXEC), 0);
    }
  }
  ::close(broken);
}

TEST(BilevelTiff, TellsAFailingDiskFromADamagedFile) {
  const TempFolder folder;
  const std::string path = std::filesystem::canonical(folder.path()).string() + "/a.tif";
  for (const std::uint16_t codec : {kNone, kPackBits, kLzw, kDeflate, kG4}) {
    for (const std::uint32_t tile_width : {0U, 64U}) {
      const TiffSpec spec{.compression = codec, .tile_width = tile_width};
      write_tiff(path, {pattern(200, 64)}, spec);
      const auto source = BilevelTiffOpener().open(path, 0);
      ASSERT_TRUE(source) << source.error().message;
      break_disk(path);
      const auto read = read_all(*source.value());
      ASSERT_FALSE(read);
      EXPECT_EQ(read.error().code, ErrorCode::io) << read.error().message;
      EXPECT_NE(read.error().message.find("row 0: cannot be read: Input/output error"), std::string::npos)
          << codec_name(codec) << tile_width << ": " << read.error().message;
    }
  }
}

TEST(BilevelTiffRefuses, PagesThatAreNotThere) {
  const TempFolder folder;
  write_tiff(folder / "a.tif", {pattern(8, 8), pattern(8, 8)}, {});
  const BilevelTiffOpener opener;
  for (const std::int64_t page : {std::int64_t{-1}, std::int64_t{2}, std::int64_t{1} << 40}) {
    const auto source = opener.open(folder / "a.tif", page);
    ASSERT_FALSE(source);
    EXPECT_EQ(source.error().code, ErrorCode::out_of_range);
    EXPECT_NE(source.error().message.find("pages 0 to 1"), std::string::npos) << source.error().message;
  }
}

TEST(BilevelTiffRefuses, RowsThatAreNotThereAndBuffersTooSmall) {
  const TempFolder folder;
  write_tiff(folder / "a.tif", {pattern(20, 8)}, {});
  const auto source = BilevelTiffOpener().open(folder / "a.tif", 0);
  std::vector<std::byte> buffer(100);
  const std::int64_t far = std::numeric_limits<std::int64_t>::max();
  for (const auto& [first, count] :
       {std::pair<std::int64_t, std::int64_t>{-1, 1}, {0, 9}, {8, 1}, {far, 1}, {1, far}, {0, -1}}) {
    const auto done = source.value()->read_rows(first, count, buffer);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::out_of_range);
  }
  const auto done = source.value()->read_rows(0, 8, std::span(buffer).first(23));
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::bad_argument);
  EXPECT_TRUE(source.value()->read_rows(0, 8, std::span(buffer).first(24)));
}

TEST(BilevelTiffRefuses, AnyOrientationButTopLeft) {
  const TempFolder folder;
  for (std::uint16_t orientation = 2; orientation <= 8; ++orientation) {
    TiffSpec spec;
    spec.orientation = orientation;
    write_tiff(folder / "o.tif", {pattern(8, 8)}, spec);
    expect_refused(folder / "o.tif", "orientation tag " + std::to_string(orientation));
  }
}

/// One grey, colour or palette page.
void write_other(const std::string& path, std::uint16_t bits, std::uint16_t samples, std::uint16_t photometric) {
  TIFF* const tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 16);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, photometric);
  std::vector<std::uint16_t> map(256);
  TIFFSetField(tiff, TIFFTAG_COLORMAP, map.data(), map.data(), map.data());
  std::vector<std::byte> row(256);
  TIFFWriteEncodedStrip(tiff, 0, row.data(), TIFFStripSize(tiff));
  TIFFClose(tiff);
}

TEST(BilevelTiffRefuses, OneSampleThatIsNeitherWhiteNorBlack) {
  const TempFolder folder;
  const std::string path = folder / "p.tif";
  for (const int bits : {1, 8}) {
    for (const int photometric : {2, 4, 5, 8, 32844, 9999, 65535}) {
      write_other(path, static_cast<std::uint16_t>(bits), 1, static_cast<std::uint16_t>(photometric));
      expect_refused(path, "PhotometricInterpretation " + std::to_string(photometric));
    }
  }
}

TEST(BilevelTiffRefuses, GreyColourAlphaAndPalettes) {
  const TempFolder folder;
  const std::string path = folder / "c.tif";
  write_other(path, 8, 1, PHOTOMETRIC_MINISBLACK);
  expect_refused(path, "1 sample(s) of 8 bit(s)");
  EXPECT_FALSE(is_bilevel_tiff(path, 0).value());
  write_other(path, 8, 3, PHOTOMETRIC_RGB);
  expect_refused(path, "3 sample(s) of 8 bit(s)");
  write_other(path, 1, 2, PHOTOMETRIC_MINISBLACK);
  expect_refused(path, "2 sample(s) of 1 bit(s)");
  EXPECT_FALSE(is_bilevel_tiff(path, 0).value());
  write_other(path, 1, 1, PHOTOMETRIC_PALETTE);
  expect_refused(path, "through a palette");
  write_tiff(path, {pattern(8, 8)}, {});
  EXPECT_TRUE(is_bilevel_tiff(path, 0).value());
  EXPECT_TRUE(is_tiff(path));
  EXPECT_FALSE(is_tiff(folder.path()));
  EXPECT_FALSE(is_tiff(folder / "none.tif"));
}

TEST(BilevelTiffRefuses, TagsThatContradictTheFile) {
  const TempFolder folder;
  const std::string path = folder / "raw.tif";
  const std::uint32_t data = raw_data_offset(9);
  const auto put = [&](std::uint32_t width, std::uint32_t height, std::uint32_t offset, std::uint32_t bytes) {
    put_file(path, raw_tiff(bilevel_tags(width, height, offset, bytes), std::string(100, '\x55')));
  };
  put(80, 10, data, 100);
  EXPECT_TRUE(open_and_read(path)) << "the same file, whole, is read";
  put(0, 10, data, 100);
  expect_refused(path, "page 0");
  put(80, 0, data, 100);
  expect_refused(path, "page 0");
  put(80, 0xFFFFFFFFU, data, 100);
  expect_refused(path, "4294967295");
  put(0xFFFFFFFFU, 10, data, 100);
  expect_refused(path, "a row is larger than");
  put(80, 0x7FFFFFFFU, data, 100);
  expect_refused(path, "ends beyond the file's");
  put(1U << 29, 0x7FFFFFFFU, data, 100);
  expect_refused(path, "page 0");
  put(80, 10, data + 1, 100);
  expect_refused(path, "ends beyond the file's");
  put(80, 10, 0xFFFFFFFFU, 100);
  expect_refused(path, "ends beyond the file's");
  put(80, 20, data, 100);
  expect_refused(path, "the file is truncated");
}

TEST(BilevelTiffRefuses, OrientationsThatLibtiffDoesNotKnow) {
  const TempFolder folder;
  for (const std::uint32_t orientation : {0U, 9U, 255U, 65535U}) {
    std::vector<RawTag> tags = bilevel_tags(80, 10, raw_data_offset(10), 100);
    tags.insert(tags.begin() + 6, {274, 3, 1, orientation});
    put_file(folder / "raw.tif", raw_tiff(tags, std::string(100, '\x55')));
    expect_refused(folder / "raw.tif", "page 0: orientation tag " + std::to_string(orientation) + ": only 1");
  }
}

/// libtiff takes a palette picture of 8 bits without colours for grey.
TEST(BilevelTiffRefuses, PalettesWithoutColours) {
  const TempFolder folder;
  for (const std::uint32_t bits : {8U, 16U}) {
    std::vector<RawTag> tags = bilevel_tags(10, 10, raw_data_offset(9), 100 * bits / 8);
    tags[2].value = bits;
    tags[4].value = PHOTOMETRIC_PALETTE;
    put_file(folder / "raw.tif", raw_tiff(tags, std::string(200, '\x55')));
    const auto info = BilevelTiffOpener().read_page_info(folder / "raw.tif", 0);
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_TRUE(info.value().palette) << bits;
    expect_refused(folder / "raw.tif", "through a palette");
  }
  std::vector<RawTag> tags = bilevel_tags(80, 10, raw_data_offset(9), 100);
  tags[4].value = PHOTOMETRIC_PALETTE;
  put_file(folder / "raw.tif", raw_tiff(tags, std::string(100, '\x55')));
  expect_refused(folder / "raw.tif", "page 0");
}

/// The lengths of two strips or tiles stand behind the directory; the data follow.
std::string two_blocks(std::uint32_t compression, bool tiled, std::uint32_t first_bytes, std::uint32_t second_bytes,
                       std::uint32_t second_offset = 0) {
  const std::size_t count = tiled ? 10 : 9;
  const std::uint32_t arrays = raw_data_offset(count);
  const std::uint32_t data = arrays + 16;
  std::vector<RawTag> tags = bilevel_tags(16, 32, 0, 0);
  tags[3].value = compression;
  tags[5] = {273, 4, 2, arrays};
  tags[7].value = 16;
  tags[8] = {279, 4, 2, arrays + 8};
  if (tiled) {
    tags = {tags[0],
            tags[1],
            tags[2],
            tags[3],
            tags[4],
            {277, 3, 1, 1},
            {322, 4, 1, 16},
            {323, 4, 1, 16},
            {324, 4, 2, arrays},
            {325, 4, 2, arrays + 8}};
  }
  std::string places;
  for (const std::uint32_t number : {data, second_offset != 0 ? second_offset : data + 32, first_bytes, second_bytes}) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
      places += static_cast<char>(number >> shift);
    }
  }
  return raw_tiff(tags, places + std::string(64, '\x55'));
}

TEST(BilevelTiffRefuses, StripsAndTilesOfImpossibleLengthOrPlace) {
  const TempFolder folder;
  const std::string path = folder / "two.tif";
  for (const bool tiled : {false, true}) {
    const std::string name = tiled ? "tile" : "strip";
    put_file(path, two_blocks(kNone, tiled, 32, 32));
    EXPECT_TRUE(open_and_read(path)) << "the same file, whole, is read";
    for (const std::uint16_t codec : {kNone, kG4, kLzw, kDeflate, kPackBits}) {
      put_file(path, two_blocks(codec, tiled, 32, 0));
      expect_refused(path, "page 0: " + name + " 1 of 2 has no data");
      put_file(path, two_blocks(codec, tiled, 32, 33));
      expect_refused(path, "page 0: " + name + " 1 of 2 (bytes ");
      put_file(path, two_blocks(codec, tiled, 32, 0xFFFFFFFFU));
      expect_refused(path, "page 0: " + name + " 1 of 2 (bytes ");
      put_file(path, two_blocks(codec, tiled, 32, 32, 0x7FFFFFFFU));
      expect_refused(path, "page 0: " + name + " 1 of 2 (bytes 2147483647 + 32) ends beyond the file's");
    }
    put_file(path, two_blocks(kNone, tiled, 32, 31));
    expect_refused(path, "page 0: " + name + " 1 of 2 has 31 bytes, its rows take 32");
  }
}

TEST(BilevelTiffRefuses, OneStripWhoseLengthLibtiffWouldGuess) {
  const TempFolder folder;
  const std::string path = folder / "one.tif";
  for (const std::uint16_t codec : {kNone, kG4, kLzw, kDeflate, kPackBits}) {
    for (const std::uint32_t bytes : {0U, 0xFFFFFFF0U}) {
      std::vector<RawTag> tags = bilevel_tags(80, 10, raw_data_offset(9), bytes);
      tags[3].value = codec;
      put_file(path, raw_tiff(tags, std::string(100, '\x55')));
      expect_refused(path, "page 0: strip 0 of 1");
    }
    std::vector<RawTag> tags = bilevel_tags(80, 10, raw_data_offset(8), 0);
    tags[3].value = codec;
    tags.pop_back();
    put_file(path, raw_tiff(tags, std::string(100, '\x55')));
    if (codec == kNone) {  // old programs leave it out; ten rows of ten bytes it is
      EXPECT_TRUE(open_and_read(path));
    } else {
      expect_refused(path, "page 0: strip 0 of 1: its length (the StripByteCounts tag) is missing");
    }
  }
  put_file(path, raw_tiff(bilevel_tags(80, 10, raw_data_offset(9), 99), std::string(100, '\x55')));
  expect_refused(path, "page 0: strip 0 of 1");
}

TEST(BilevelTiffRefuses, PagesWithoutPolarity) {
  const TempFolder folder;
  std::vector<RawTag> tags = bilevel_tags(80, 10, raw_data_offset(8), 100);
  tags.erase(tags.begin() + 4);
  put_file(folder / "raw.tif", raw_tiff(tags, std::string(100, '\x55')));
  expect_refused(folder / "raw.tif", "has no polarity");
}

TEST(BilevelTiffRefuses, PageChainsThatRunInACircleOrOutOfTheFile) {
  const TempFolder folder;
  const std::string path = folder / "chain.tif";
  const auto tags = bilevel_tags(80, 10, raw_data_offset(9), 100);
  put_file(path, raw_tiff(tags, std::string(100, '\x55'), 8));
  expect_refused(path, "runs in a circle");
  put_file(path, raw_tiff(tags, std::string(100, '\x55'), 0xFFFFFFF0U));
  expect_refused(path, "page 1: its directory (at byte 4294967280");
  put_file(path, raw_tiff(tags, std::string(100, '\xFF'), raw_data_offset(9)));
  expect_refused(path, "65535 entries) does not fit");
}

TEST(BilevelTiffRefuses, EveryTruncation) {
  const TempFolder folder;
  const std::string path = folder / "cut.tif";
  const Bits bits = pattern(80, 24);
  const std::string data(reinterpret_cast<const char*>(bits.bytes.data()), bits.bytes.size());
  const auto raw = raw_tiff(bilevel_tags(80, 24, raw_data_offset(9), static_cast<std::uint32_t>(data.size())), data);
  put_file(path, raw);
  ASSERT_EQ(open_and_read(path).value(), bits) << "directory first: only the pixels go missing";
  for (std::size_t length = 0; length < raw.size(); ++length) {
    put_file(path, raw.substr(0, length));
    const auto read = open_and_read(path);
    ASSERT_FALSE(read) << "cut at byte " << length;
    ASSERT_EQ(read.error().code, ErrorCode::bad_file);
  }
}

TEST(BilevelTiffRefuses, EveryTruncationOfEveryCodec) {
  const TempFolder folder;
  for (const std::uint16_t compression : {kNone, kPackBits, kLzw, kDeflate, kG4, kZstd}) {
    TiffSpec spec;
    spec.compression = compression;
    write_tiff(folder / "whole.tif", {pattern(90, 40)}, spec);
    const std::string whole = file_bytes(folder / "whole.tif");
    for (std::size_t length = 0; length < whole.size(); ++length) {
      put_file(folder / "cut.tif", whole.substr(0, length));
      ASSERT_FALSE(open_and_read(folder / "cut.tif")) << codec_name(compression) << " cut at byte " << length;
    }
  }
}

/// libtiff's fax decoder reports half of all damage as a warning and invents the missing rows.
TEST(BilevelTiffRefuses, FaxDataThatEndEarly) {
  const TempFolder folder;
  const std::string path = folder / "fax.tif";
  const std::string three_rows("\x26\xA0\xBE\x26\xA0", 5);
  auto tags = bilevel_tags(64, 4000, raw_data_offset(9), static_cast<std::uint32_t>(three_rows.size()));
  tags[3].value = kG4;
  put_file(path, raw_tiff(tags, three_rows));
  testing::internal::CaptureStderr();
  expect_refused(path, "page 0: row 0: the image data are damaged or truncated");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "libraries never print";
}

TEST(BilevelTiffRefuses, OrReadsDamageWithoutHarm) {
  const std::uint32_t seed = image_test_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  std::mt19937 rng(seed);
  const TempFolder folder;
  for (const std::uint16_t compression : {kNone, kPackBits, kLzw, kDeflate, kG4, kG3, kZstd}) {
    for (const std::uint32_t tile_width : {0U, 32U}) {
      TiffSpec spec;
      spec.compression = compression;
      spec.tile_width = tile_width;
      write_tiff(folder / "whole.tif", {pattern(150, 60)}, spec);
      const std::string whole = file_bytes(folder / "whole.tif");
      for (int trial = 0; trial < 150; ++trial) {
        std::string bytes = whole;
        for (int flips = 0; flips < 1 + trial % 4; ++flips) {
          char& byte = bytes[rng() % bytes.size()];
          byte = static_cast<char>(byte ^ static_cast<char>(1U << (rng() % 8)));
        }
        put_file(folder / "bad.tif", bytes);
        const auto read = open_and_read(folder / "bad.tif");  // either is right; crashing or hanging is not
        if (!read) {
          EXPECT_FALSE(read.error().message.empty());
        }
      }
    }
  }
}

}  // namespace
}  // namespace gravure::test
