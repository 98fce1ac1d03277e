#include "byte_file.hpp"
#include "gravure/core/file_output.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace gravure::grv {
namespace {

class DiskFile : public ByteFile {
 public:
  DiskFile(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
  DiskFile(const DiskFile&) = delete;
  DiskFile& operator=(const DiskFile&) = delete;
  ~DiskFile() override { ::close(fd_); }

  const std::string& path() const noexcept override { return path_; }

  Result<std::uint64_t> size() const override {
    struct stat status = {};
    if (::fstat(fd_, &status) != 0) {
      return failure("cannot ask for the size");
    }
    return static_cast<std::uint64_t>(status.st_size);
  }

  Result<std::size_t> read(std::uint64_t offset, std::span<std::byte> out) const override {
    const std::int64_t got = read_file_at(fd_, static_cast<std::int64_t>(offset), out);
    if (got < 0) {
      return failure("cannot read");
    }
    return static_cast<std::size_t>(got);
  }

  Result<void> write(std::uint64_t offset, std::span<const std::byte> bytes) override {
    return write_at(fd_, offset, bytes);
  }

  Result<void> resize(std::uint64_t bytes) override {
    if (::ftruncate(fd_, static_cast<off_t>(bytes)) != 0) {
      return failure("cannot set the size");
    }
    return {};
  }

  Result<void> flush() override { return {}; }

 protected:
  int fd() const noexcept { return fd_; }

  Result<void> write_at(int fd, std::uint64_t offset, std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
      const ssize_t put = ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (put < 0 && errno == EINTR) {
        continue;
      }
      if (put <= 0) {
        return failure("cannot write");
      }
      offset += static_cast<std::uint64_t>(put);
      bytes = bytes.subspan(static_cast<std::size_t>(put));
    }
    return {};
  }

 private:
  Error failure(const char* what) const { return {ErrorCode::io, path_ + ": " + what + ": " + std::strerror(errno)}; }
  int fd_;
  std::string path_;
};

/// Gathers what is written in a row. Whole pages of long rows go past the page cache: filling it with fresh pages costs
/// several times what the disk does, and pushes out what other programs have there. Everything else, and all of it
/// where the file system does not allow that, takes the usual way. One thread at a time.
class GatheringFile final : public DiskFile {
 public:
  GatheringFile(int fd, std::string path) : DiskFile(fd, std::move(path)) {}
  GatheringFile(const GatheringFile&) = delete;
  GatheringFile& operator=(const GatheringFile&) = delete;
  ~GatheringFile() override {
    if (direct_ >= 0) {
      ::close(direct_);
    }
  }

  Result<std::uint64_t> size() const override {
    GRAVURE_TRY(const std::uint64_t stored, DiskFile::size());
    return std::max(stored, gathered_ > 0 ? end() : 0);
  }

  Result<std::size_t> read(std::uint64_t offset, std::span<std::byte> out) const override {
    if (gathered_ > 0 && offset < end() && offset + out.size() > begin_) {
      GRAVURE_CHECK(write_gathered());
    }
    return DiskFile::read(offset, out);
  }

  Result<void> write(std::uint64_t offset, std::span<const std::byte> bytes) override {
    if (offset != end()) {
      GRAVURE_CHECK(flush());
    }
    if (gathered_ == 0) {
      begin_ = offset;
    }
    if (block_ == nullptr) {
      block_.reset(static_cast<std::byte*>(std::aligned_alloc(kBlockBytes, kBlockBytes)));
      if (block_ == nullptr) {
        return Error{ErrorCode::io, path() + ": cannot write: out of memory"};
      }
      // A huge page costs a fraction of its 512 small ones; where there is none to be had, nothing is lost.
      ::madvise(block_.get(), kBlockBytes, MADV_HUGEPAGE);
    }
    while (!bytes.empty()) {
      // Bytes lie in the block as in the pages of the file.
      const std::size_t used = begin_ % kPageBytes + gathered_;
      const std::size_t count = std::min(bytes.size(), kBlockBytes - used);
      std::copy_n(bytes.data(), count, block_.get() + used);
      gathered_ += count;
      bytes = bytes.subspan(count);
      if (used + count == kBlockBytes) {
        GRAVURE_CHECK(flush());
      }
    }
    return {};
  }

  Result<void> resize(std::uint64_t bytes) override {
    GRAVURE_CHECK(flush());
    return DiskFile::resize(bytes);
  }

  Result<void> flush() override {
    if (gathered_ < kDirectBytes || !write_pages()) {  // the usual way succeeds, or says why not
      GRAVURE_CHECK(write_gathered());
    }
    begin_ = end();
    gathered_ = 0;
    return {};
  }

 private:
  static constexpr std::size_t kPageBytes = 4096;
  static constexpr std::size_t kBlockBytes = std::size_t{1} << 21;
  static constexpr std::size_t kDirectBytes = std::size_t{1} << 16;  // below, waiting for the disk costs more

  struct Free {
    void operator()(std::byte* block) const { std::free(block); }
  };

  std::uint64_t end() const { return begin_ + gathered_; }

  /// What is gathered stays gathered: writing it again does no harm.
  Result<void> write_gathered() const {
    if (gathered_ == 0) {
      return {};
    }
    return write_at(fd(), begin_, {block_.get() + begin_ % kPageBytes, gathered_});
  }

  /// Whole pages go straight to the disk, what is left at either end the usual way. False where that is not allowed or
  /// did not succeed: then any of it may have been written.
  bool write_pages() {
    if (!tried_direct_) {
      tried_direct_ = true;
      // The very file that is open, whatever its path has come to mean.
      const std::string self = "/proc/self/fd/" + std::to_string(fd());
      direct_ = ::open(self.c_str(), O_WRONLY | O_DIRECT | O_CLOEXEC);
    }
    if (direct_ < 0) {
      return false;
    }
    const std::size_t first = begin_ % kPageBytes;
    const std::size_t used = first + gathered_;
    const std::size_t pages_begin = first == 0 ? 0 : kPageBytes;
    const std::size_t pages_end = used / kPageBytes * kPageBytes;
    const std::uint64_t block_at = begin_ - first;
    const auto part = [&](std::size_t from, std::size_t to) { return std::span(block_.get() + from, to - from); };
    if (!write_at(direct_, block_at + pages_begin, part(pages_begin, pages_end))) {
      ::close(std::exchange(direct_, -1));
      return false;
    }
    return write_at(fd(), begin_, part(first, pages_begin)) &&
           write_at(fd(), block_at + pages_end, part(pages_end, used));
  }

  int direct_ = -1;
  bool tried_direct_ = false;
  std::unique_ptr<std::byte, Free> block_;
  std::uint64_t begin_ = 0;
  std::size_t gathered_ = 0;
};

class ImageFile final : public ByteFile {
 public:
  explicit ImageFile(std::span<const std::byte> image) : image_(image) {}
  const std::string& path() const noexcept override { return path_; }
  Result<std::uint64_t> size() const override { return static_cast<std::uint64_t>(image_.size()); }
  Result<std::size_t> read(std::uint64_t offset, std::span<std::byte> out) const override {
    if (offset >= image_.size()) {
      return std::size_t{0};
    }
    const std::size_t count = std::min(out.size(), image_.size() - static_cast<std::size_t>(offset));
    std::copy_n(image_.data() + offset, count, out.data());
    return count;
  }
  Result<void> write(std::uint64_t /*offset*/, std::span<const std::byte> /*bytes*/) override { return read_only(); }
  Result<void> resize(std::uint64_t /*bytes*/) override { return read_only(); }
  Result<void> flush() override { return {}; }

 private:
  static Error read_only() { return {ErrorCode::io, "program in memory: is read-only"}; }
  std::span<const std::byte> image_;
  std::string path_ = "program in memory";
};

}  // namespace

Result<std::unique_ptr<ByteFile>> open_file(const std::string& path, OpenFor purpose, const std::string& shown_path) {
  // O_NONBLOCK: a pipe named by mistake is refused below instead of waiting for a writer.
  const int access = purpose == OpenFor::writing ? O_RDWR : O_RDONLY;
  const int fd = ::open(path.c_str(), access | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) {
    return open_error(shown_path, errno);
  }
  std::unique_ptr<ByteFile> file;
  if (purpose == OpenFor::writing) {
    file = std::make_unique<GatheringFile>(fd, shown_path);
  } else {
    file = std::make_unique<DiskFile>(fd, shown_path);
  }
  struct stat status = {};
  if (::fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
    return Error{ErrorCode::bad_file, shown_path + ": is not a regular file; give the path of a program"};
  }
  return file;
}

std::unique_ptr<ByteFile> open_image(std::span<const std::byte> image) {
  return std::make_unique<ImageFile>(image);
}

Result<void> read_exactly(const ByteFile& file, std::uint64_t offset, std::span<std::byte> out) {
  GRAVURE_TRY(const std::size_t got, file.read(offset, out));
  if (got != out.size()) {
    return Error{ErrorCode::bad_file, file.path() + ": ends at byte " + std::to_string(offset + got) + ", " +
                                          std::to_string(out.size() - got) + " bytes too early: get a whole copy"};
  }
  return {};
}

}  // namespace gravure::grv
