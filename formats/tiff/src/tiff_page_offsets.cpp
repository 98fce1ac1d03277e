#include "tiff_page_offsets.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <span>
#include <unordered_set>

#include "gravure/core/file_output.hpp"
#include "gravure/formats/tiff.hpp"

namespace gravure {
namespace {

constexpr std::size_t kRememberedFiles = 16;

/// False, with errno 0, where the file ends before.
bool read_all_at(int fd, std::uint64_t offset, unsigned char* out, std::size_t bytes) {
  errno = 0;
  return read_file_at(fd, static_cast<std::int64_t>(offset), std::as_writable_bytes(std::span(out, bytes))) ==
         static_cast<std::int64_t>(bytes);
}

class ReadOnlyFile {
 public:
  explicit ReadOnlyFile(const std::string& path) : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ReadOnlyFile(const ReadOnlyFile&) = delete;
  ReadOnlyFile& operator=(const ReadOnlyFile&) = delete;
  ~ReadOnlyFile() {
    if (fd_ >= 0) {
      ::close(fd_);
    }
  }
  int fd() const { return fd_; }
  bool read_at(std::uint64_t offset, unsigned char* out, std::size_t bytes) const {
    return read_all_at(fd_, offset, out, bytes);
  }

 private:
  int fd_;
};

/// The byte order and widths of a TIFF header: "II" or "MM", 42 (classic) or 43 (BigTIFF).
struct Layout {
  bool big_endian = false;
  bool big = false;

  std::uint64_t number(const unsigned char* bytes, std::size_t count) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      value = value << 8 | bytes[big_endian ? i : count - 1 - i];
    }
    return value;
  }
  std::size_t count_bytes() const { return big ? 8 : 2; }
  std::uint64_t entry_bytes() const { return big ? 20 : 12; }
  std::size_t offset_bytes() const { return big ? 8 : 4; }
};

std::optional<Layout> parse_layout(const unsigned char* header) {
  Layout layout;
  if (header[0] == 'M' && header[1] == 'M') {
    layout.big_endian = true;
  } else if (header[0] != 'I' || header[1] != 'I') {
    return std::nullopt;
  }
  const std::uint64_t version = layout.number(header + 2, 2);
  layout.big = version == 43;
  return version == 42 || version == 43 ? std::optional(layout) : std::nullopt;
}

/// One number in place, of any of TIFF's unsigned types.
std::optional<std::uint64_t> small_value(const Layout& layout, const unsigned char* entry) {
  constexpr std::uint64_t kByte = 1;
  constexpr std::uint64_t kShort = 3;
  constexpr std::uint64_t kLong = 4;
  const std::uint64_t type = layout.number(entry + 2, 2);
  const unsigned char* const value = entry + (layout.big ? 12 : 8);
  return type == kByte    ? std::optional(layout.number(value, 1))
         : type == kShort ? std::optional(layout.number(value, 2))
         : type == kLong  ? std::optional(layout.number(value, 4))
                          : std::nullopt;
}

/// io where the last read failed.
Error damaged(const std::string& path, std::size_t page, const std::string& what) {
  if (const int reason = errno; is_device_failure(reason)) {
    return read_error(path + ": page " + std::to_string(page) + ": its directory", reason);
  }
  return {ErrorCode::bad_file,
          path + ": page " + std::to_string(page) + ": " + what + ": the file is truncated or damaged; copy it again"};
}

/// The offset that follows the directory at `offset`, 0 for the last one.
Result<std::uint64_t> next_offset(const ReadOnlyFile& file, const Layout& layout, std::uint64_t file_bytes,
                                  std::uint64_t offset, const std::string& path, std::size_t page) {
  std::array<unsigned char, 8> bytes{};
  const std::string where = "its directory (at byte " + std::to_string(offset) + " of " + std::to_string(file_bytes);
  errno = 0;
  if (offset >= file_bytes || !file.read_at(offset, bytes.data(), layout.count_bytes())) {
    return damaged(path, page, where + ") lies outside the file");
  }
  const std::uint64_t entries = layout.number(bytes.data(), layout.count_bytes());
  const std::uint64_t left = file_bytes - offset;
  const std::uint64_t around = layout.count_bytes() + layout.offset_bytes();
  if (entries == 0 || left < around || entries > (left - around) / layout.entry_bytes()) {
    return damaged(path, page, where + ", " + std::to_string(entries) + " entries) does not fit");
  }
  const std::uint64_t link = offset + layout.count_bytes() + entries * layout.entry_bytes();
  if (!file.read_at(link, bytes.data(), layout.offset_bytes())) {
    return damaged(path, page, where + ") cannot be read");
  }
  return layout.number(bytes.data(), layout.offset_bytes());
}

Result<TiffPageList> walk(const ReadOnlyFile& file, const std::string& path, std::uint64_t file_bytes) {
  std::array<unsigned char, 16> header{};
  const std::size_t have = file.read_at(0, header.data(), 16) ? 16 : (file.read_at(0, header.data(), 8) ? 8 : 0);
  if (const int reason = errno; have == 0 && is_device_failure(reason)) {
    return read_error(path, reason);
  }
  const auto layout = have == 0 ? std::nullopt : parse_layout(header.data());
  if (!layout || (layout->big && have < 16)) {
    return Error{ErrorCode::bad_file,
                 path + ": is not a TIFF file (it begins with none of its four signatures) or ends within its header"};
  }
  TiffPageList pages;
  pages.file_bytes = file_bytes;
  std::unordered_set<std::uint64_t> seen;
  std::uint64_t offset = layout->big ? layout->number(header.data() + 8, 8) : layout->number(header.data() + 4, 4);
  if (offset == 0) {
    return damaged(path, 0, "its directory was never written");
  }
  while (offset != 0) {
    const std::size_t page = pages.offsets.size();
    if (page >= static_cast<std::size_t>(kMaxTiffPages) || !seen.insert(offset).second) {
      return damaged(path, page, "the chain of pages runs in a circle or past " + std::to_string(kMaxTiffPages));
    }
    GRAVURE_TRY(const std::uint64_t next, next_offset(file, *layout, file_bytes, offset, path, page));
    pages.offsets.push_back(offset);
    offset = next;
  }
  return pages;
}

bool same_file(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino && a.st_size == b.st_size &&
         a.st_mtim.tv_sec == b.st_mtim.tv_sec && a.st_mtim.tv_nsec == b.st_mtim.tv_nsec;
}

Result<struct stat> status_of(const ReadOnlyFile& file, const std::string& path) {
  struct stat status = {};
  if (file.fd() < 0 || ::fstat(file.fd(), &status) != 0) {
    return open_error(path, errno);
  }
  if (!S_ISREG(status.st_mode)) {
    return Error{ErrorCode::bad_file,
                 path + (S_ISDIR(status.st_mode) ? ": is a folder" : ": is no regular file") + ", not an image"};
  }
  return status;
}

}  // namespace

Result<std::shared_ptr<const TiffPageList>> TiffPageOffsets::find(const std::string& path) {
  const ReadOnlyFile file(path);
  GRAVURE_TRY(const struct stat status, status_of(file, path));
  const auto is_it = [&](const Entry& entry) { return entry.path == path && same_file(entry.status, status); };
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(entries_.begin(), entries_.end(), is_it);
    if (found != entries_.end()) {
      return found->pages;
    }
  }
  GRAVURE_TRY(TiffPageList walked, walk(file, path, static_cast<std::uint64_t>(status.st_size)));
  auto pages = std::make_shared<const TiffPageList>(std::move(walked));
  const std::lock_guard lock(mutex_);
  if (entries_.size() >= kRememberedFiles) {
    entries_.erase(entries_.begin());
  }
  entries_.push_back({path, status, pages});
  return pages;
}

TiffRawTags read_raw_tags(int fd, std::uint64_t offset) {
  constexpr std::uint64_t kPhotometric = 262;
  constexpr std::uint64_t kOrientation = 274;
  TiffRawTags tags;
  std::array<unsigned char, 20> bytes{};
  const auto layout = read_all_at(fd, 0, bytes.data(), 4) ? parse_layout(bytes.data()) : std::nullopt;
  if (!layout || !read_all_at(fd, offset, bytes.data(), layout->count_bytes())) {
    return tags;
  }
  const std::uint64_t entries = layout->number(bytes.data(), layout->count_bytes());
  for (std::uint64_t i = 0; i < entries; ++i) {
    const std::uint64_t at = offset + layout->count_bytes() + i * layout->entry_bytes();
    if (!read_all_at(fd, at, bytes.data(), static_cast<std::size_t>(layout->entry_bytes()))) {
      break;
    }
    const std::uint64_t tag = layout->number(bytes.data(), 2);
    if (tag == kPhotometric && !tags.photometric) {
      tags.photometric = small_value(*layout, bytes.data());
    } else if (tag == kOrientation && !tags.orientation) {
      tags.orientation = small_value(*layout, bytes.data());
    }
  }
  return tags;
}

bool is_tiff(const std::string& path) {
  const ReadOnlyFile file(path);
  struct stat status = {};
  std::array<unsigned char, 4> magic{};
  return file.fd() >= 0 && ::fstat(file.fd(), &status) == 0 && S_ISREG(status.st_mode) &&
         file.read_at(0, magic.data(), magic.size()) && parse_layout(magic.data()).has_value();
}

}  // namespace gravure
