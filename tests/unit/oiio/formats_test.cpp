#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "format_set.hpp"
#include "gravure/formats/image_files.hpp"
#include "sample_sets.hpp"
#include "temp_folder.hpp"

namespace gravure::test {
namespace {

using samples::format_files;
using samples::FormatFile;
using samples::kFormatHeight;
using samples::kFormatWidth;

/// Is the pixel white, by the middle of the sample's range?
bool is_white(const ImageInfo& info, const std::byte* row, std::int64_t x) {
  switch (info.samples) {
    case SampleType::bit: {
      const bool one = (row[x / 8] & static_cast<std::byte>(0x80U >> static_cast<unsigned>(x % 8))) != std::byte{0};
      return one != info.zero_is_white;
    }
    case SampleType::u8:
      return row[x] >= std::byte{128};
    case SampleType::u16: {
      std::uint16_t value = 0;
      std::memcpy(&value, row + 2 * x, 2);
      return value >= 32768;
    }
    case SampleType::f32: {
      float value = 0;
      std::memcpy(&value, row + 4 * x, 4);
      return value >= 0.5F;
    }
  }
  return false;
}

class FormatSet : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder();
    for (const auto& set : samples::sample_sets()) {
      if (set.name == "formats") {
        const auto made = set.make(folder_->path());
        ASSERT_TRUE(made) << made.error().message;
      }
    }
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static std::string path(const FormatFile& file) { return *folder_ / file.name; }

  static TempFolder* folder_;
  ImageFiles files_;
};
TempFolder* FormatSet::folder_ = nullptr;

void expect_picture(ImageSource& source, std::int64_t page) {
  const ImageInfo& info = source.info();
  ASSERT_EQ(info.width, kFormatWidth);
  ASSERT_EQ(info.height, kFormatHeight);
  const std::int64_t stride = row_bytes(info.samples, info.width);
  std::vector<std::byte> rows(static_cast<std::size_t>(stride * info.height));
  const auto done = source.read_rows(0, info.height, rows);
  ASSERT_TRUE(done) << done.error().message;
  for (std::int64_t y = 0; y < kFormatHeight; ++y) {
    for (std::int64_t x = 0; x < kFormatWidth; ++x) {
      ASSERT_EQ(is_white(info, rows.data() + y * stride, x), samples::format_pixel(x, y, page)) << x << ", " << y;
    }
  }
}

TEST_F(FormatSet, IsReadBackPixelForPixelFromEveryFile) {
  for (const FormatFile& file : format_files()) {
    SCOPED_TRACE(file.name);
    const auto pages = files_.count_pages(path(file));
    ASSERT_TRUE(pages) << pages.error().message;
    ASSERT_EQ(pages.value(), file.pages);
    for (std::int64_t page = 0; page < file.pages; ++page) {
      const auto source = files_.open(path(file), page);
      ASSERT_TRUE(source) << source.error().message;
      EXPECT_EQ(source.value()->info().page, page);
      expect_picture(*source.value(), page);
    }
  }
}

TEST_F(FormatSet, KeepsTheDepthOfItsSamples) {
  for (const FormatFile& file : format_files()) {
    const auto source = files_.open(path(file), 0);
    ASSERT_TRUE(source) << source.error().message;
    const SampleType expected = file.options.samples == samples::Samples::bit   ? SampleType::bit
                                : file.options.samples == samples::Samples::u8  ? SampleType::u8
                                : file.options.samples == samples::Samples::u16 ? SampleType::u16
                                                                                : SampleType::f32;
    EXPECT_EQ(source.value()->info().samples, expected) << file.name;
  }
}

TEST_F(FormatSet, GivesTheSameRowsInPartsAsWhole) {
  const std::uint32_t seed = image_test_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  std::mt19937 rng(seed);
  for (const FormatFile& file : format_files()) {
    SCOPED_TRACE(file.name);
    const auto source = files_.open(path(file), 0);
    ASSERT_TRUE(source) << source.error().message;
    const ImageInfo& info = source.value()->info();
    const std::int64_t stride = row_bytes(info.samples, info.width);
    std::vector<std::byte> part(static_cast<std::size_t>(stride * info.height));
    std::int64_t next = 0;
    for (int trial = 0; trial < 40; ++trial) {
      // Upwards where the file says that it must be; anywhere else otherwise.
      std::int64_t first = static_cast<std::int64_t>(rng() % static_cast<std::uint64_t>(kFormatHeight));
      if (!info.random_access) {
        first = next >= kFormatHeight ? 0 : next + static_cast<std::int64_t>(rng() % 3) % (kFormatHeight - next);
      }
      const auto most = static_cast<std::uint64_t>(kFormatHeight - first);
      const std::int64_t count =
          1 + static_cast<std::int64_t>(rng() % (info.random_access ? most : std::min(most, std::uint64_t{20})));
      ASSERT_TRUE(source.value()->read_rows(first, count, part));
      for (std::int64_t y = first; y < first + count; ++y) {
        for (std::int64_t x = 0; x < kFormatWidth; x += 7) {
          ASSERT_EQ(is_white(info, part.data() + (y - first) * stride, x), samples::format_pixel(x, y, 0));
        }
      }
      next = first + count;
    }
  }
}

TEST_F(FormatSet, RefusesPagesAndRowsThatAreNotThere) {
  for (const FormatFile& file : format_files()) {
    SCOPED_TRACE(file.name);
    for (const std::int64_t page : {std::int64_t{-1}, std::int64_t{file.pages}}) {
      const auto source = files_.open(path(file), page);
      ASSERT_FALSE(source);
      EXPECT_EQ(source.error().code, ErrorCode::out_of_range) << source.error().message;
    }
    const auto source = files_.open(path(file), 0);
    ASSERT_TRUE(source);
    std::vector<std::byte> buffer(static_cast<std::size_t>(4 * kFormatWidth));
    for (const auto& [first, count] : {std::pair<std::int64_t, std::int64_t>{-1, 1}, {kFormatHeight, 1}, {0, -1}}) {
      const auto done = source.value()->read_rows(first, count, buffer);
      ASSERT_FALSE(done);
      EXPECT_EQ(done.error().code, ErrorCode::out_of_range);
    }
    const auto small = source.value()->read_rows(0, 1, std::span(buffer).first(3));
    ASSERT_FALSE(small);
    EXPECT_EQ(small.error().code, ErrorCode::bad_argument);
  }
}

TEST_F(FormatSet, IsRefusedWhereverItIsCutOff) {
  for (const FormatFile& file : format_files()) {
    SCOPED_TRACE(file.name);
    const std::string whole = file_bytes(path(file));
    // OpenEXR and TIFF may end with bytes nobody needs; all but the last 64 are needed for sure.
    for (std::size_t cut = 0; cut + 64 < whole.size(); cut += 1 + whole.size() / 40) {
      put_file(*folder_ / "cut", whole.substr(0, cut));
      bool good = true;
      std::string message;
      for (std::int64_t page = 0; page < file.pages && good; ++page) {
        const auto source = files_.open(*folder_ / "cut", page);
        good = static_cast<bool>(source);
        message = good ? "" : source.error().message;
        if (good) {
          const ImageInfo& info = source.value()->info();
          std::vector<std::byte> rows(static_cast<std::size_t>(row_bytes(info.samples, info.width) * info.height));
          const auto done = source.value()->read_rows(0, info.height, rows);
          good = static_cast<bool>(done);
          message = good ? "" : done.error().message;
        }
      }
      ASSERT_FALSE(good) << "cut at byte " << cut << " of " << whole.size();
      ASSERT_NE(message.find("cut"), std::string::npos) << "names the file: " << message;
    }
  }
}

TEST_F(FormatSet, NeverCrashesOnDamage) {
  const std::uint32_t seed = image_test_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  std::mt19937 rng(seed);
  for (const FormatFile& file : format_files()) {
    const std::string whole = file_bytes(path(file));
    for (int trial = 0; trial < 25; ++trial) {
      std::string bytes = whole;
      const std::size_t reach = trial % 2 == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 400);
      for (int flips = 0; flips <= trial % 3; ++flips) {
        char& byte = bytes[rng() % reach];
        byte = static_cast<char>(byte ^ static_cast<char>(1U << (rng() % 8)));
      }
      put_file(*folder_ / "bad", bytes);
      const auto source = files_.open(*folder_ / "bad", 0);  // refused or read: either is right
      if (source && source.value()->info().width <= 1000 && source.value()->info().height <= 1000) {
        const ImageInfo& info = source.value()->info();
        std::vector<std::byte> rows(static_cast<std::size_t>(row_bytes(info.samples, info.width) * info.height));
        static_cast<void>(static_cast<bool>(source.value()->read_rows(0, info.height, rows)));
      }
    }
  }
}

}  // namespace
}  // namespace gravure::test
