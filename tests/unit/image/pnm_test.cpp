#include <gtest/gtest.h>

#include "gravure/formats/image_files.hpp"
#include "temp_folder.hpp"

namespace gravure::test {
namespace {

class Pnm : public testing::Test {
 protected:
  Result<std::unique_ptr<ImageSource>> open(const std::string& bytes, std::int64_t page = 0) {
    put_file(folder_ / "a.pnm", bytes);
    return files_.open(folder_ / "a.pnm", page);
  }
  void expect_refused(const std::string& bytes, const std::string& words) {
    const auto source = open(bytes);
    ASSERT_FALSE(source) << words;
    EXPECT_EQ(source.error().code, ErrorCode::bad_file);
    EXPECT_NE(source.error().message.find(words), std::string::npos) << source.error().message;
  }
  static std::string rows(ImageSource& source, std::int64_t first, std::int64_t count) {
    std::string read(static_cast<std::size_t>(count * row_bytes(source.info().samples, source.info().width)), '\0');
    const auto done = source.read_rows(first, count, std::as_writable_bytes(std::span(read.data(), read.size())));
    EXPECT_TRUE(done) << done.error().message;
    return read;
  }

  TempFolder folder_;
  ImageFiles files_;
};

TEST_F(Pnm, GivesTheBitsOfPbmPackedWithZeroAsWhite) {
  const auto source = open("P4\n# made by hand\n10 # wide\n\t3\nABCDEF");
  ASSERT_TRUE(source) << source.error().message;
  const ImageInfo& info = source.value()->info();
  EXPECT_EQ(info.width, 10);
  EXPECT_EQ(info.height, 3);
  EXPECT_EQ(info.samples, SampleType::bit);
  EXPECT_TRUE(info.zero_is_white);
  EXPECT_EQ(rows(*source.value(), 0, 3), "ABCDEF");
  EXPECT_EQ(rows(*source.value(), 2, 1), "EF");
  EXPECT_EQ(rows(*source.value(), 0, 1), "AB");
  EXPECT_EQ(files_.count_pages(folder_ / "a.pnm").value(), 1);
}

TEST_F(Pnm, GivesTheSamplesOfPgmInHostOrder) {
  const auto bytes = open("P5 3 2 255\nabcdef");
  ASSERT_TRUE(bytes) << bytes.error().message;
  EXPECT_EQ(bytes.value()->info().samples, SampleType::u8);
  EXPECT_EQ(rows(*bytes.value(), 1, 1), "def");
  const auto words = open("P5 2 1 65535\nabcd");
  ASSERT_TRUE(words) << words.error().message;
  EXPECT_EQ(words.value()->info().samples, SampleType::u16);
  EXPECT_EQ(rows(*words.value(), 0, 1), "badc");
}

TEST_F(Pnm, RefusesColourTextAndOddMaxima) {
  expect_refused("P6 1 1 255\nabc", "is in colour");
  expect_refused("P3 1 1 255\n1 2 3", "is in colour");
  expect_refused("P1\n2 1\n1 0", "is a plain text");
  expect_refused("P2\n2 1 255\n1 0", "is a plain text");
  expect_refused("P5 1 1 254\na", "declared as 254");
  expect_refused("P5 1 1 65536\nab", "declared as 65536");
}

TEST_F(Pnm, RefusesSizesThatTheFileDoesNotHold) {
  expect_refused("P4 0 1\n", "does not give a width and height");
  expect_refused("P4 8 -1\na", "does not give a width and height");
  expect_refused("P4 8\n", "does not give a width and height");
  expect_refused("P4 8 99999999999999999999\n", "does not give a width and height");
  expect_refused("P4 8 2147483648\n", "does not give a width and height");
  expect_refused("P4 8 2147483647\na", "the file is truncated");
  expect_refused("P4 2147483647 1\na", "a row is larger than");
  expect_refused("P4 8 2\na", "the file is truncated");
  expect_refused("P4 8 2\nabc", "1 bytes follow");
  expect_refused("P4 8 2", "does not give a width and height");
  const auto second = open("P4 8 1\na", 1);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::out_of_range);
}

TEST_F(Pnm, RefusesRowsThatAreNotThere) {
  const auto source = open("P4 8 2\nab");
  ASSERT_TRUE(source);
  std::byte buffer[2];
  EXPECT_EQ(source.value()->read_rows(2, 1, buffer).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(source.value()->read_rows(-1, 1, buffer).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(source.value()->read_rows(0, 2, std::span(buffer).first(1)).error().code, ErrorCode::bad_argument);
  std::filesystem::resize_file(folder_ / "a.pnm", 8);
  const auto cut = source.value()->read_rows(0, 2, buffer);
  ASSERT_FALSE(cut);
  EXPECT_NE(cut.error().message.find("row 1: the file ends"), std::string::npos) << cut.error().message;
}

}  // namespace
}  // namespace gravure::test
