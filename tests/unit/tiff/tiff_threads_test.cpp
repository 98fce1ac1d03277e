#include <gtest/gtest.h>

#include <thread>

#include "gravure/formats/tiff.hpp"
#include "temp_folder.hpp"
#include "tiff_maker.hpp"

namespace gravure::test {
namespace {

TEST(BilevelTiffThreads, ShareOneOpenerAndKeepTheirErrorsApart) {
  const TempFolder folder;
  const Bits bits = pattern(200, 64);
  TiffSpec spec;
  spec.compression = 8;  // Deflate
  write_tiff(folder / "good.tif", {bits, bits, bits}, spec);
  std::string bytes = file_bytes(folder / "good.tif");
  bytes[12] ^= 0x7F;  // inside the first strip
  put_file(folder / "bad.tif", bytes);

  const BilevelTiffOpener opener;
  int good = 0;
  int bad = 0;
  const auto read = [&](const std::string& path, std::int64_t page) {
    const auto source = opener.open(path, page);
    return source && read_all(*source.value());
  };
  std::thread other([&] {
    for (int i = 0; i < 200; ++i) {
      bad += read(folder / "bad.tif", 0) ? 0 : 1;
    }
  });
  for (int i = 0; i < 200; ++i) {
    good += read(folder / "good.tif", i % 3) ? 1 : 0;
  }
  other.join();
  EXPECT_EQ(good, 200);
  EXPECT_EQ(bad, 200);
}

}  // namespace
}  // namespace gravure::test
