#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "gravure/formats/tiff.hpp"
#include "gravure/formats/tiff_writer.hpp"
#include "temp_folder.hpp"
#include "tiff_maker.hpp"

namespace gravure::test {
namespace {

constexpr TiffCompression kAllCompressions[] = {TiffCompression::none, TiffCompression::packbits,
                                                TiffCompression::lzw,  TiffCompression::deflate,
                                                TiffCompression::g4,   TiffCompression::zstd};

BilevelTiffPage page_of(const Bits& bits, TiffCompression compression = TiffCompression::deflate) {
  BilevelTiffPage page;
  page.width = bits.width;
  page.height = bits.height;
  page.compression = compression;
  return page;
}

Result<void> write_whole(const std::string& path, const Bits& bits, const BilevelTiffPage& page) {
  GRAVURE_TRY(BilevelTiffWriter writer, BilevelTiffWriter::create(path, page));
  GRAVURE_CHECK(writer.append_rows(bits.bytes));
  return writer.commit();
}

TEST(BilevelTiffWriter, WritesWhatTheReaderReads) {
  const TempFolder folder;
  const Bits bits = pattern(3501, 700);  // several strips
  for (const TiffCompression compression : kAllCompressions) {
    for (const bool zero_is_white : {false, true}) {
      BilevelTiffPage page = page_of(bits, compression);
      page.zero_is_white = zero_is_white;
      page.x_dots_per_mm = 125.0;
      page.y_dots_per_mm = 100.0;
      const auto written = write_whole(folder / "w.tif", bits, page);
      ASSERT_TRUE(written) << written.error().message;
      const auto source = BilevelTiffOpener().open(folder / "w.tif", 0);
      ASSERT_TRUE(source) << source.error().message;
      EXPECT_EQ(source.value()->info().zero_is_white, zero_is_white);
      EXPECT_NEAR(source.value()->info().x_dots_per_mm.value(), 125, 1e-4);
      EXPECT_NEAR(source.value()->info().y_dots_per_mm.value(), 100, 1e-4);
      EXPECT_EQ(read_all(*source.value()).value(), bits);
    }
  }
}

TEST(BilevelTiffWriter, GivesTheSameBytesForTheSameRowsHoweverTheyAreCut) {
  const TempFolder folder;
  Bits bits = pattern(333, 5000);
  ASSERT_TRUE(write_whole(folder / "a.tif", bits, page_of(bits)));
  // Bits beyond the width are not pixels: they must not show in the file.
  for (std::int64_t row = 1; row <= bits.height; ++row) {
    bits.bytes[static_cast<std::size_t>(row * bits.row_size() - 1)] |= std::byte{0x07};
  }
  auto writer = BilevelTiffWriter::create(folder / "b.tif", page_of(bits));
  ASSERT_TRUE(writer);
  const std::span<const std::byte> all(bits.bytes);
  const auto row_size = static_cast<std::size_t>(bits.row_size());
  for (std::size_t row = 0; row < 5000; row += 50) {
    ASSERT_TRUE(writer.value().append_rows(all.subspan(row * row_size, 50 * row_size)));
  }
  ASSERT_TRUE(writer.value().commit());
  EXPECT_EQ(file_bytes(folder / "a.tif"), file_bytes(folder / "b.tif"));
}

TEST(BilevelTiffWriter, WritesPagesOfTheirOwnSize) {
  const TempFolder folder;
  const std::vector<Bits> pages = {pattern(10, 10), pattern(100, 3), pattern(1, 1)};
  auto writer = BilevelTiffWriter::create(folder / "p.tif", page_of(pages[0]), 3);
  ASSERT_TRUE(writer);
  for (std::size_t i = 0; i < pages.size(); ++i) {
    if (i > 0) {
      ASSERT_TRUE(writer.value().begin_page(page_of(pages[i], kAllCompressions[i])));
    }
    ASSERT_TRUE(writer.value().append_rows(pages[i].bytes));
  }
  ASSERT_TRUE(writer.value().commit());
  const BilevelTiffOpener opener;
  ASSERT_EQ(opener.count_pages(folder / "p.tif").value(), 3);
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const auto source = opener.open(folder / "p.tif", static_cast<std::int64_t>(i));
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ(read_all(*source.value()).value(), pages[i]);
  }
}

TEST(BilevelTiffWriter, BecomesBigTiffOnlyWhereClassicMightNotHold) {
  const TempFolder folder;
  const Bits bits = pattern(64, 2);
  const auto version_for = [&](TiffCompression compression, std::int64_t pages) {
    auto writer = BilevelTiffWriter::create(folder / "v.tif", page_of(bits, compression), pages);
    EXPECT_TRUE(writer && writer.value().append_rows(bits.bytes) && writer.value().commit());
    return file_bytes(folder / "v.tif").at(2);
  };
  EXPECT_EQ(version_for(TiffCompression::none, 1), 42);
  EXPECT_EQ(version_for(TiffCompression::none, 218'000'000), 42);  // 3.488 GB
  EXPECT_EQ(version_for(TiffCompression::none, 219'000'000), 43);  // 3.504 GB
  EXPECT_EQ(version_for(TiffCompression::g4, 100'000'000), 43);    // 1.6 GB raw, fax codes may take 2.5 times that
}

TEST(BilevelTiffWriter, LeavesNothingBehindWhenNotCommitted) {
  const TempFolder folder;
  const Bits bits = pattern(64, 8);
  put_file(folder / "old.tif", "what was there before");
  {
    auto writer = BilevelTiffWriter::create(folder / "old.tif", page_of(bits));
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer.value().append_rows(std::span(bits.bytes).first(8)));
    const auto early = writer.value().commit();
    ASSERT_FALSE(early);
    EXPECT_EQ(early.error().code, ErrorCode::bad_argument);
    EXPECT_NE(early.error().message.find("1 of its 8 rows"), std::string::npos) << early.error().message;
  }
  EXPECT_EQ(file_bytes(folder / "old.tif"), "what was there before");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(BilevelTiffWriter, RefusesRowsAndSizesThatDoNotFit) {
  const TempFolder folder;
  const Bits bits = pattern(64, 2);
  auto writer = BilevelTiffWriter::create(folder / "a.tif", page_of(bits));
  ASSERT_TRUE(writer);
  EXPECT_EQ(writer.value().append_rows(std::span(bits.bytes).first(7)).error().code, ErrorCode::bad_argument);
  ASSERT_TRUE(writer.value().append_rows(bits.bytes));
  EXPECT_EQ(writer.value().append_rows(std::span(bits.bytes).first(8)).error().code, ErrorCode::bad_argument);
  BilevelTiffPage bad = page_of(bits);
  bad.width = 0;
  EXPECT_EQ(BilevelTiffWriter::create(folder / "b.tif", bad).error().code, ErrorCode::out_of_range);
  bad.width = kMaxTiffRowBytes * 8 + 1;
  EXPECT_EQ(BilevelTiffWriter::create(folder / "b.tif", bad).error().code, ErrorCode::out_of_range);
  bad = page_of(bits);
  bad.height = std::int64_t{1} << 31;
  EXPECT_EQ(BilevelTiffWriter::create(folder / "b.tif", bad).error().code, ErrorCode::out_of_range);
  bad = page_of(bits);
  bad.x_dots_per_mm = 5.0;
  EXPECT_EQ(BilevelTiffWriter::create(folder / "b.tif", bad).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(BilevelTiffWriter::create(folder / "no/such/folder.tif", page_of(bits)).error().code, ErrorCode::io);
}

TEST(BilevelTiffWriter, SaysWhenTheDiskIsFullAndLeavesNothing) {
  const TempFolder folder;
  const Bits bits = pattern(8000, 2000);
  struct rlimit before = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const struct rlimit small = {100'000, before.rlim_max};  // stands for a full disk, as root too
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto written = write_whole(folder / "x.tif", bits, page_of(bits, TiffCompression::none));
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::io);
  EXPECT_NE(written.error().message.find("is the disk full?"), std::string::npos) << written.error().message;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace gravure::test
