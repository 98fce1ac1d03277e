// Any bytes as a TIFF, PNG, BMP or OpenEXR for the import module: opened and
// read, or refused; never a crash, a hang, or memory beyond the stated limits.

#include <stdlib.h>  // mkstemp is POSIX
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "oiio_opener.hpp"

namespace {

constexpr std::int64_t kPages = 4;
constexpr std::int64_t kBytesRead = std::int64_t{4} << 20;  // of one page: blank pages may be gigapixels

void read_page(const gravure::ImageOpener& opener, const std::string& path, std::int64_t page) {
  const auto source = opener.open(path, page);
  if (!source) {
    return;
  }
  const gravure::ImageInfo& info = source.value()->info();
  const std::int64_t stride = gravure::row_bytes(info.samples, info.width);
  const std::int64_t rows = std::min(info.height, std::max<std::int64_t>(1, kBytesRead / stride));
  std::vector<std::byte> buffer(static_cast<std::size_t>(rows * stride));
  if (source.value()->read_rows(0, rows, buffer) && info.random_access) {
    static_cast<void>(static_cast<bool>(source.value()->read_rows(info.height - 1, 1, buffer)));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  char path[] = "/dev/shm/gravure-fuzz-XXXXXX";
  const int file = ::mkstemp(path);
  if (file < 0 || ::write(file, data, size) != static_cast<ssize_t>(size)) {
    std::perror(path);
    std::abort();
  }
  ::close(file);
  const gravure::oiio::OiioOpener opener;
  if (const auto pages = opener.count_pages(path)) {
    for (std::int64_t page = 0; page < std::min(pages.value(), kPages); ++page) {
      read_page(opener, path, page);
    }
  }
  ::unlink(path);
  return 0;
}
