#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure {

/// Where the directories of a TIFF lie, in page order.
struct TiffPageList {
  std::vector<std::uint64_t> offsets;
  std::uint64_t file_bytes = 0;
};

/// Tags as a directory has them. libtiff replaces some it does not like: a palette without colours by grey, an
/// orientation it does not know by the usual one.
struct TiffRawTags {
  std::optional<std::uint64_t> photometric;
  std::optional<std::uint64_t> orientation;
};

/// Of the directory at `offset` of an open file; no tag where it cannot be read.
TiffRawTags read_raw_tags(int fd, std::uint64_t offset);

/// Finds the pages of TIFF files in one walk a file and remembers those of the latest files. Thread-safe.
class TiffPageOffsets {
 public:
  /// Fails with bad_file: missing, no regular file, no TIFF, a chain of directories that leaves the file or runs in a
  /// circle; io: the system refuses to read.
  Result<std::shared_ptr<const TiffPageList>> find(const std::string& path);

 private:
  /// A file that was rewritten since is walked again.
  struct Entry {
    std::string path;
    struct stat status;
    std::shared_ptr<const TiffPageList> pages;
  };
  std::mutex mutex_;
  std::vector<Entry> entries_;  // latest last
};

}  // namespace gravure
