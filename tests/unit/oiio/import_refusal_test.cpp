#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include "gravure/formats/image_files.hpp"
#include "raw_images.hpp"
#include "temp_folder.hpp"

namespace gravure::test {
namespace {

class ImportRefuses : public testing::Test {
 protected:
  void expect_refused(const std::string& name, const std::string& words) {
    const auto source = files_.open(folder_ / name, 0);
    ASSERT_FALSE(source) << words;
    EXPECT_EQ(source.error().code, ErrorCode::bad_file);
    EXPECT_NE(source.error().message.find(words), std::string::npos) << source.error().message;
    EXPECT_NE(source.error().message.find(name), std::string::npos) << source.error().message;
  }
  void refuse_png(const RawPng& png, const std::string& words) {
    put_file(folder_ / "a.png", png_file(png));
    expect_refused("a.png", words);
  }
  void refuse_bmp(const RawBmp& bmp, const std::string& words) {
    put_file(folder_ / "a.bmp", bmp_file(bmp));
    expect_refused("a.bmp", words);
  }
  /// 8 x 8 float samples, whatever the channels and windows.
  void write_exr(const OIIO::ImageSpec& spec) {
    const std::vector<float> values(256);
    const auto output = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(output->open(folder_ / "a.exr", spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeFloat, values.data()));
    ASSERT_TRUE(output->close());
  }

  TempFolder folder_;
  ImageFiles files_;
};

TEST_F(ImportRefuses, ColourAlphaAndPalettesOfPng) {
  RawPng png;
  png.depth = 8;
  png.rows = std::string(128, '\0');
  const std::string what_to_do = "save it as greyscale or 1 bit";
  for (const auto& [type, words] : {std::pair<int, const char*>{2, "is in colour"},
                                    {3, "has a palette"},
                                    {4, "has transparency"},
                                    {6, "is in colour"}}) {
    png.colour_type = type;
    refuse_png(png, words);
    refuse_png(png, what_to_do);
  }
  png = {};
  png.rows = std::string(4, '\0');
  png.more_chunks = png_chunk("tRNS", std::string("\0\1", 2));
  refuse_png(png, "has transparency (tRNS)");
}

TEST_F(ImportRefuses, DepthsAndOrdersOfPngThatWouldBeGuessed) {
  RawPng png;
  png.rows = std::string(16, '\0');
  for (const int depth : {2, 4}) {
    png.depth = depth;
    refuse_png(png, std::to_string(depth) + " bits a sample");
  }
  png.depth = 1;
  png.interlace = 1;
  refuse_png(png, "is interlaced");
}

TEST_F(ImportRefuses, PngWithAnyDamagedChunk) {
  RawPng png;
  png.rows = std::string("\xA5\x0F\xFF\x00", 4);
  const std::string good = png_file(png);
  for (std::size_t at = 8; at < good.size(); ++at) {
    std::string bytes = good;
    bytes[at] ^= 0x10;
    put_file(folder_ / "a.png", bytes);
    EXPECT_FALSE(files_.open(folder_ / "a.png", 0)) << "byte " << at;
  }
  put_file(folder_ / "a.png", good.substr(0, good.size() - 12));
  expect_refused("a.png", "reaches beyond the end of the file");
}

/// Chunks with right checksums whose contents are damaged: what libpng would print is in the error, nowhere else.
TEST_F(ImportRefuses, PngOfDamagedDataWithoutAWordOfLibpng) {
  RawPng png;
  png.height = 200;
  for (int i = 0; i < 400; ++i) {
    png.rows += static_cast<char>(i * 37 + i / 7);
  }
  const std::string good = png_file(png);
  const std::size_t idat = good.find("IDAT");
  const std::string packed = good.substr(idat + 4, good.size() - 12 - 4 - idat - 4);
  const auto with_data = [&](const std::string& data) {
    return good.substr(0, idat - 4) + png_chunk("IDAT", data) + png_chunk("IEND", "");
  };
  const auto read = [&](const std::string& bytes) {
    put_file(folder_ / "a.png", bytes);
    std::vector<std::byte> rows(400);
    testing::internal::CaptureStderr();
    const auto source = files_.open(folder_ / "a.png", 0);
    const Result<void> done = source ? source.value()->read_rows(0, 200, rows) : Result<void>(source.error());
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    return done ? std::string() : done.error().message;
  };
  EXPECT_EQ(read(good), "");
  EXPECT_EQ(read(with_data(packed + "more")), "") << "what follows the picture is not of it";
  for (const auto& [bytes, words] :
       {std::pair{good.substr(0, good.size() / 2), "reaches beyond the end of the file"},
        {with_data(packed.substr(0, packed.size() / 2)), "(Not enough image data)"},
        {with_data(packed.substr(0, packed.size() - 4) + "abcd"), "(IDAT: incorrect data check)"},
        {with_data("\x78\x9c\xff\xff\xff"), "row 0: the image data are damaged or truncated; copy or export the file"},
        {good.substr(0, idat - 4) + png_chunk("IEND", ""), "IEND: out of place"},
        {good.substr(0, idat - 4) + png_chunk("ABCD", "") + good.substr(idat - 4), "unhandled critical chunk"}}) {
    EXPECT_NE(read(bytes).find(words), std::string::npos) << words << " is not in: " << read(bytes);
  }
  put_file(folder_ / "a.png", with_data(packed.substr(0, packed.size() / 2)));
  const auto source = files_.open(folder_ / "a.png", 0);
  ASSERT_TRUE(source) << source.error().message;
  std::vector<std::byte> row(2);
  EXPECT_TRUE(source.value()->read_rows(3, 1, row)) << "rows before the damage are whole";
  EXPECT_FALSE(source.value()->read_rows(199, 1, row));
  EXPECT_TRUE(source.value()->read_rows(3, 1, row)) << "also after a refusal";
  EXPECT_EQ(row[0], static_cast<std::byte>(png.rows[6]));
}

TEST_F(ImportRefuses, PngThatDeclareMoreThanTheyHold) {
  RawPng png;
  png.rows = std::string(1, '\0');
  for (const auto& [width, height] : {std::pair<std::uint32_t, std::uint32_t>{0, 1}, {1, 0}}) {
    png.width = width;
    png.height = height;
    refuse_png(png, "both must be 1 or more");
  }
  png.height = 1;
  png.width = 0xFFFFFFFFU;
  refuse_png(png, "a row is larger than");
  png.width = 1'000'001;
  refuse_png(png, "PNG is read up to 1000000 a side");
  png.width = png.height = 1'000'000;
  refuse_png(png, "bytes of data cannot hold");
}

TEST_F(ImportRefuses, ColourPalettesAndPackingsOfBmp) {
  RawBmp bmp;
  bmp.data = std::string(8, '\0');
  bmp.palette = {0x000000, 0x0000FF};
  refuse_bmp(bmp, "has a palette of other than black and white");
  bmp.palette = {0x000000, 0x000000};
  refuse_bmp(bmp, "has a palette of other than black and white");
  bmp.palette = {0x000000, 0xFFFFFF};
  bmp.compression = 1;
  refuse_bmp(bmp, "is compressed (1)");
  bmp.compression = 0;
  bmp.data = std::string(128, '\0');
  bmp.bits = 4;
  refuse_bmp(bmp, "4 bits a pixel");
  for (const int bits : {16, 24, 32}) {
    bmp.bits = bits;
    refuse_bmp(bmp, std::to_string(bits) + " bits a pixel (colour)");
  }
  bmp.bits = 8;
  bmp.palette.assign(256, 0x123456);
  refuse_bmp(bmp, "3 channels");
}

TEST_F(ImportRefuses, BmpThatDeclareMoreThanTheyHold) {
  RawBmp bmp;
  bmp.data = std::string(8, '\0');
  for (const auto& [width, height, words] :
       {std::tuple<std::int32_t, std::int32_t, const char*>{0, 2, "both must be 1 or more"},
        {16, 0, "both must be 1 or more"},
        {-16, 2, "both must be 1 or more"},
        {16, 3, "the file is truncated"},
        {2'000'000'000, 2, "a row is larger than"},
        {500'000'000, 2'147'483'647, "the file is truncated"},
        {16, -2'147'483'647 - 1, "the file is truncated"}}) {
    bmp.width = width;
    bmp.height = height;
    refuse_bmp(bmp, words);
  }
  put_file(folder_ / "a.bmp", "BM and no header");
  expect_refused("a.bmp", "no BMP header");
}

TEST_F(ImportRefuses, ColourAlphaAndUnsignedSamplesOfOpenExr) {
  OIIO::ImageSpec colour(8, 8, 3, OIIO::TypeHalf);
  write_exr(colour);
  expect_refused("a.exr", "3 channels (R, G, B)");
  OIIO::ImageSpec alpha(8, 8, 1, OIIO::TypeHalf);
  alpha.channelnames = {"A"};
  alpha.alpha_channel = 0;
  write_exr(alpha);
  expect_refused("a.exr", "its only channel is transparency");
  OIIO::ImageSpec words(8, 8, 1, OIIO::TypeUInt32);
  words.channelnames = {"Y"};
  write_exr(words);
  expect_refused("a.exr", "its samples are uint");
}

TEST_F(ImportRefuses, OpenExrWhoseWindowsDiffer) {
  OIIO::ImageSpec spec(8, 8, 1, OIIO::TypeHalf);
  spec.channelnames = {"Y"};
  spec.full_width = 10;
  write_exr(spec);
  expect_refused("a.exr", "is not its display window (10 x 8)");
}

TEST_F(ImportRefuses, OpenExrOfUnknownPixelTypesAndFewerSamplesThanPixels) {
  write_exr(OIIO::ImageSpec(8, 4, 1, OIIO::TypeHalf));
  const std::string good = file_bytes(folder_ / "a.exr");
  const std::size_t list = good.find(std::string("channels\0chlist\0", 16)) + 20;
  const std::size_t channel = good.find('\0', list) + 1;
  const auto with = [&](std::size_t at, std::uint8_t value) {
    std::string bytes = good;
    bytes[at] = static_cast<char>(value);
    put_file(folder_ / "a.exr", bytes);
  };
  with(channel, 3);  // OpenImageIO would abort
  expect_refused("a.exr", "channel 0 is of the unknown pixel type 3");
  with(channel + 8, 2);
  expect_refused("a.exr", "channel 0 has fewer samples than pixels");
  with(list, 0);
  expect_refused("a.exr", "its list of channels is empty");
  with(list - 4, 17);  // its size
  expect_refused("a.exr", "its list of channels does not end");
  with(list - 18, 'x');
  expect_refused("a.exr", "sizes that do not fit");
}

TEST_F(ImportRefuses, OpenExrAttributesWhoseSizeIsNotThatOfTheirType) {
  write_exr(OIIO::ImageSpec(8, 4, 1, OIIO::TypeHalf));
  const std::string good = file_bytes(folder_ / "a.exr");
  for (const auto& [name, type] : {std::pair<std::string, std::string>{"dataWindow", "box2i"},
                                   {"screenWindowCenter", "v2f"},
                                   {"pixelAspectRatio", "float"},
                                   {"lineOrder", "lineOrder"},
                                   {"compression", "compression"}}) {
    std::string bytes = good;
    const std::string head = name + '\0' + type + '\0';
    ++bytes[bytes.find(head) + head.size()];
    put_file(folder_ / "a.exr", bytes);
    expect_refused("a.exr", "sizes that do not fit");
  }
  const std::size_t end = good.find(std::string("screenWindowWidth"));
  for (const auto& [attribute, words] :
       {std::pair{std::string("p\0preview\0\x0C\0\0\0\2\0\0\0\2\0\0\0\0\0\0\0", 26), "sizes that do not fit"},
        {std::string("s\0stringvector\0\6\0\0\0\xFF\0\0\0ab", 26), "sizes that do not fit"},
        {std::string("f\0floatvector\0\2\0\0\0ab", 20), "sizes that do not fit"}}) {
    put_file(folder_ / "a.exr", good.substr(0, end) + attribute + good.substr(end));
    expect_refused("a.exr", words);
  }
  const std::string fine("s\0stringvector\0\6\0\0\0\2\0\0\0ab", 25);
  put_file(folder_ / "a.exr", good.substr(0, end) + fine + good.substr(end));
  EXPECT_TRUE(files_.open(folder_ / "a.exr", 0));
}

TEST_F(ImportRefuses, OpenExrThatDeclareMoreThanTheyHold) {
  OIIO::ImageSpec spec(8, 8, 1, OIIO::TypeHalf);
  spec.channelnames = {"Y"};
  write_exr(spec);
  const std::string good = file_bytes(folder_ / "a.exr");
  const std::size_t window = good.find(std::string("dataWindow\0box2i\0", 17)) + 17 + 4;
  const auto with = [&](std::size_t corner, std::uint32_t value) {
    std::string bytes = good;
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[window + 4 * corner + i] = static_cast<char>(value >> (8 * i));
    }
    put_file(folder_ / "a.exr", bytes);
  };
  with(2, 0x7FFFFFFF);
  expect_refused("a.exr", "a row is larger than");
  with(2, 0x000FFFFF);
  expect_refused("a.exr", "OpenEXR is read up to 262144");
  with(2, 0xFFFFFFFF);
  expect_refused("a.exr", "both must be 1 or more");
  with(3, 0x7FFFFFFF);
  expect_refused("a.exr", "bytes cannot hold");
}

TEST_F(ImportRefuses, ColourAlphaPalettesAndOddDepthsOfTiff) {
  write_plain_tiff(folder_ / "a.tif", 8, 3, PHOTOMETRIC_RGB);
  expect_refused("a.tif", "3 channels (colour or transparency)");
  write_plain_tiff(folder_ / "a.tif", 8, 2, PHOTOMETRIC_MINISBLACK);
  expect_refused("a.tif", "2 channels (colour or transparency)");
  write_plain_tiff(folder_ / "a.tif", 8, 1, PHOTOMETRIC_PALETTE);
  expect_refused("a.tif", "has a palette");
  write_plain_tiff(folder_ / "a.tif", 1, 1, PHOTOMETRIC_PALETTE);
  expect_refused("a.tif", "through a palette");
  for (const int bits : {2, 4, 12, 64}) {
    write_plain_tiff(folder_ / "a.tif", bits, 1, PHOTOMETRIC_MINISBLACK);
    expect_refused("a.tif", std::to_string(bits) + " bits a sample");
  }
  write_plain_tiff(folder_ / "a.tif", 16, 1, PHOTOMETRIC_MINISBLACK, SAMPLEFORMAT_INT);
  expect_refused("a.tif", "its samples are int16");
  write_plain_tiff(folder_ / "a.tif", 32, 1, PHOTOMETRIC_MINISBLACK, SAMPLEFORMAT_UINT);
  expect_refused("a.tif", "its samples are uint");
  write_plain_tiff(folder_ / "a.tif", 16, 1, PHOTOMETRIC_MINISWHITE);
  expect_refused("a.tif", "0 is white");
}

}  // namespace
}  // namespace gravure::test
