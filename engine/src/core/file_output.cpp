#include "gravure/core/file_output.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace gravure {
namespace {

/// What the user can do about it, if we know.
const char* remedy(int reason) {
  switch (reason) {
    case ENOENT:
    case ENOTDIR:
      return ": check the path";
    case EACCES:
    case EPERM:
    case EROFS:
      return ": check its permissions";
    case ENOSPC:
    case EDQUOT:
      return ": make room or choose another disk";
    case ENAMETOOLONG:
      return ": give a shorter name";
    default:
      return "";
  }
}

Error system_error(const std::string& what, const std::string& path) {
  return {ErrorCode::io, path + ": " + what + ": " + std::strerror(errno) + remedy(errno)};
}

/// Closes on every way out.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) {
      ::close(fd_);
    }
  }
  int get() const { return fd_; }
  bool valid() const { return fd_ >= 0; }

 private:
  int fd_;
};

Result<void> sync_path(const std::string& path, int flags) {
  const Descriptor file(::open(path.c_str(), flags | O_CLOEXEC));
  if (!file.valid()) {
    return system_error("cannot open to sync", path);
  }
  // Some file systems cannot sync a folder; that is theirs to say, not a failure of ours.
  if (::fsync(file.get()) != 0 && errno != EINVAL && errno != EROFS) {
    return system_error("cannot sync to disk", path);
  }
  return {};
}

Result<void> write_all(int fd, std::string_view content, const std::string& path) {
  while (!content.empty()) {
    const ssize_t written = ::write(fd, content.data(), content.size());
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      return system_error("cannot write", path);
    }
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

// A handler of signals asks for it.
std::atomic<int> begun{0};
static_assert(std::atomic<int>::is_always_lock_free);

}  // namespace

bool FileOutput::any_begun() noexcept {
  return begun > 0;
}

FileOutput::FileOutput(std::string path, std::string temporary)
    : path_(std::move(path)), temporary_(std::move(temporary)) {}

FileOutput::FileOutput(FileOutput&& other) noexcept
    : path_(std::exchange(other.path_, {})), temporary_(std::exchange(other.temporary_, {})), synced_(other.synced_) {}

FileOutput& FileOutput::operator=(FileOutput&& other) noexcept {
  discard();
  path_ = std::exchange(other.path_, {});
  temporary_ = std::exchange(other.temporary_, {});
  synced_ = other.synced_;
  return *this;
}

FileOutput::~FileOutput() {
  discard();
}

void FileOutput::discard() noexcept {
  if (!temporary_.empty()) {
    ::unlink(temporary_.c_str());
    temporary_.clear();
    --begun;
  }
}

Result<FileOutput> FileOutput::create(const std::string& path) {
  std::error_code ignored;
  if (path.empty() || std::filesystem::is_directory(path, ignored)) {
    return Error{ErrorCode::io, "output \"" + path + "\" is a folder: give a file name"};
  }
  if (path == "-") {
    return Error{ErrorCode::bad_argument,
                 "output \"-\": a file appears whole or not at all, standard output cannot; give a file name"};
  }
  // Renaming onto a link, device or pipe would replace it, not write to it.
  const std::filesystem::file_status there = std::filesystem::symlink_status(path, ignored);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) {
    return Error{ErrorCode::io,
                 "output \"" + path + "\" is not a regular file: it cannot appear whole; give a file name"};
  }
  // Created as any new file is, so that the umask and the folder's own rules hold; O_EXCL keeps the name ours.
  static std::atomic<unsigned> counter{0};
  constexpr int kMostTries = 1000;  // names left behind by a crash are passed over
  ++begun;                          // before there is a file: a signal between the two must not miss it
  for (int tries = 0; tries < kMostTries; ++tries) {
    std::string temporary = path + ".part-" + std::to_string(::getpid()) + "-" + std::to_string(counter.fetch_add(1));
    const Descriptor file(::open(temporary.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.valid()) {
      return FileOutput(path, std::move(temporary));
    }
    if (errno != EEXIST) {
      --begun;
      return system_error("cannot create the output", path);
    }
  }
  --begun;
  return system_error("cannot find a free temporary name beside the output", path);
}

Result<void> FileOutput::sync() {
  if (!synced_) {
    GRAVURE_CHECK(sync_path(temporary_, O_RDONLY));
    synced_ = true;
  }
  return {};
}

Result<void> FileOutput::commit() {
  GRAVURE_CHECK(sync());
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) {
    return system_error("cannot put the finished file in its place", path_);
  }
  temporary_.clear();
  const std::string folder = std::filesystem::path(path_).parent_path().string();
  return sync_path(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
}

Result<FileOutput> stage_file(const std::string& path, std::string_view content) {
  GRAVURE_TRY(FileOutput output, FileOutput::create(path));
  const Descriptor file(::open(output.temporary_path().c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC));
  if (!file.valid()) {
    return system_error("cannot open the output", path);
  }
  GRAVURE_CHECK(write_all(file.get(), content, path));
  GRAVURE_CHECK(output.sync());
  return output;
}

Result<void> write_file(const std::string& path, std::string_view content) {
  GRAVURE_TRY(FileOutput output, stage_file(path, content));
  return output.commit();
}

Error open_error(const std::string& path, int reason) {
  const bool mendable = reason == ENOENT || reason == ENOTDIR || reason == EACCES || reason == EISDIR ||
                        reason == ELOOP || reason == ENAMETOOLONG || reason == ENXIO;
  return {mendable ? ErrorCode::bad_file : ErrorCode::io,
          path + ": cannot open: " + std::strerror(reason) + remedy(reason)};
}

std::int64_t read_file_at(int file, std::int64_t offset, std::span<std::byte> out) noexcept {
  std::size_t done = 0;
  while (done < out.size()) {
    const ssize_t got =
        ::pread(file, out.data() + done, out.size() - done, static_cast<off_t>(offset + static_cast<off_t>(done)));
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got < 0) {
      return -1;
    }
    if (got == 0) {
      break;
    }
    done += static_cast<std::size_t>(got);
  }
  return static_cast<std::int64_t>(done);
}

Error read_error(const std::string& where, int reason) {
  return {ErrorCode::io, where + ": cannot be read: " + std::strerror(reason) + ": check the disk or the network"};
}

bool is_device_failure(int reason) noexcept {
  constexpr std::array<int, 15> kFailures = {EIO,       ENODEV,    ENXIO,        ESTALE,     ETIMEDOUT,
                                             EREMOTEIO, EUCLEAN,   EBADMSG,      ENOTCONN,   EHOSTDOWN,
                                             ENETDOWN,  ENETRESET, ECONNABORTED, ECONNRESET, EHOSTUNREACH};
  return std::find(kFailures.begin(), kFailures.end(), reason) != kFailures.end();
}

Result<std::string> read_file(const std::string& path, std::size_t max_bytes) {
  const auto too_large = [&] {
    return Error{ErrorCode::bad_file, path + ": larger than the " + std::to_string(max_bytes) + " bytes allowed here"};
  };
  // O_NONBLOCK: a pipe named by mistake is refused below instead of waiting for a writer.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.valid()) {
    return open_error(path, errno);
  }
  struct stat status = {};
  if (::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return Error{ErrorCode::bad_file, path + ": is not a regular file; give the path of one"};
  }
  if (static_cast<std::uint64_t>(status.st_size) > max_bytes) {
    return too_large();
  }
  std::string content;
  char buffer[65536];
  while (true) {
    const ssize_t got = ::read(file.get(), buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got < 0) {
      return system_error("cannot read", path);
    }
    if (got == 0) {
      return content;
    }
    content.append(buffer, static_cast<std::size_t>(got));
    if (content.size() > max_bytes) {  // it grew meanwhile
      return too_large();
    }
  }
}

}  // namespace gravure
