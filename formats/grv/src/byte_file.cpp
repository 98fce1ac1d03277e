#include "byte_file.hpp"
#include "gravure/core/file_output.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace gravure::grv {
namespace {

class DiskFile final : public ByteFile {
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
    std::size_t done = 0;
    while (done < out.size()) {
      const ssize_t got = ::pread(fd_, out.data() + done, out.size() - done, static_cast<off_t>(offset + done));
      if (got < 0 && errno == EINTR) {
        continue;
      }
      if (got < 0) {
        return failure("cannot read");
      }
      if (got == 0) {
        break;
      }
      done += static_cast<std::size_t>(got);
    }
    return done;
  }

  Result<void> write(std::uint64_t offset, std::span<const std::byte> bytes) override {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t put = ::pwrite(fd_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
      if (put < 0 && errno == EINTR) {
        continue;
      }
      if (put <= 0) {
        return failure("cannot write");
      }
      done += static_cast<std::size_t>(put);
    }
    return {};
  }

  Result<void> resize(std::uint64_t bytes) override {
    if (::ftruncate(fd_, static_cast<off_t>(bytes)) != 0) {
      return failure("cannot set the size");
    }
    return {};
  }

 private:
  Error failure(const char* what) const { return {ErrorCode::io, path_ + ": " + what + ": " + std::strerror(errno)}; }
  int fd_;
  std::string path_;
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
  auto file = std::make_unique<DiskFile>(fd, shown_path);
  struct stat status = {};
  if (::fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
    return Error{ErrorCode::bad_file, shown_path + ": is not a regular file; give the path of a program"};
  }
  return std::unique_ptr<ByteFile>(std::move(file));
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
