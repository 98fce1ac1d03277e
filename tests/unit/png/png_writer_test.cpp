#include "gravure/formats/png_writer.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <new>
#include <string>
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

TEST(PngWriter, GivesTheSameBytesRowByRow) {
  for (const int samples : {1, 3}) {
    const std::vector<std::byte> pixels = pixels_of(samples * 301 * 97);
    const std::size_t row_bytes = static_cast<std::size_t>(samples) * 301;
    std::string file;
    const Result<void> written = write_png(
        {301, 97, samples, {}},
        [&](std::int64_t y, std::span<std::byte> row) -> Result<void> {
          EXPECT_EQ(row.size(), row_bytes);
          std::copy_n(pixels.begin() + y * static_cast<std::int64_t>(row_bytes), row_bytes, row.begin());
          return {};
        },
        [&](std::span<const std::byte> piece) {
          file.append(reinterpret_cast<const char*>(piece.data()), piece.size());
          return true;
        });
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_EQ(file, encode_png({301, 97, samples, pixels}).value());
  }
}

TEST(PngWriter, StopsWhereARowOrTheFileFails) {
  const PngRows grey = [](std::int64_t, std::span<std::byte>) -> Result<void> { return {}; };
  const PngBytes keep = [](std::span<const std::byte>) { return true; };
  const PngRows stop = [](std::int64_t y, std::span<std::byte>) -> Result<void> {
    return y < 3 ? Result<void>() : Error{ErrorCode::cancelled, "stopped"};
  };
  EXPECT_EQ(write_png({9, 9, 1, {}}, stop, keep).error().code, ErrorCode::cancelled);
  for (const std::size_t most : {0U, 40U}) {  // in the header, at the end
    std::size_t bytes = 0;
    const PngBytes full = [&](std::span<const std::byte> piece) { return (bytes += piece.size()) <= most; };
    EXPECT_EQ(write_png({9, 9, 1, {}}, grey, full).error().code, ErrorCode::io);
  }
  const PngBytes greedy = [](std::span<const std::byte>) -> bool { throw std::bad_alloc(); };
  EXPECT_EQ(write_png({9, 9, 1, {}}, grey, greedy).error().code, ErrorCode::io);
  EXPECT_EQ(write_png({9, kMostPngSide + 1, 1, {}}, grey, keep).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(write_png({9, 9, 2, {}}, grey, keep).error().code, ErrorCode::bad_argument);
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
