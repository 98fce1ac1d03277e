#include "gravure/formats/png_writer.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <vector>

namespace gravure {
namespace {

std::vector<std::byte> pixels_of(std::int64_t count) {
  std::vector<std::byte> pixels;
  for (std::int64_t i = 0; i < count; ++i) {
    pixels.push_back(static_cast<std::byte>(i * 37 % 256));
  }
  return pixels;
}

std::vector<std::byte> decode(const std::string& file, unsigned format) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, file.data(), file.size()), 0);
  image.format = format;
  std::vector<std::byte> pixels(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
  return pixels;
}

TEST(PngWriter, IsReadBackAsItWasGiven) {
  const std::vector<std::byte> grey = pixels_of(17 * 5);
  const Result<std::string> written = encode_png({17, 5, 1, grey});
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(decode(written.value(), PNG_FORMAT_GRAY), grey);
  const std::vector<std::byte> colours = pixels_of(3 * 4 * 9);
  const Result<std::string> coloured = encode_png({4, 9, 3, colours});
  ASSERT_TRUE(coloured) << coloured.error().message;
  EXPECT_EQ(decode(coloured.value(), PNG_FORMAT_RGB), colours);
}

TEST(PngWriter, GivesTheSameBytesForTheSamePixels) {
  const std::vector<std::byte> grey = pixels_of(100);
  EXPECT_EQ(encode_png({10, 10, 1, grey}).value(), encode_png({10, 10, 1, grey}).value());
}

TEST(PngWriter, RefusesSizesThatDoNotFit) {
  const std::vector<std::byte> grey = pixels_of(100);
  EXPECT_EQ(encode_png({0, 10, 1, grey}).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(encode_png({10, kMostPngSide + 1, 1, grey}).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(encode_png({10, 11, 1, grey}).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(encode_png({10, 5, 2, grey}).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace gravure
