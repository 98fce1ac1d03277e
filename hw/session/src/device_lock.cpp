#include "gravure/session/device_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace gravure::session {
namespace {

constexpr mode_t kEverybody = 0666;  // boards belong to no user, and neither do their locks

/// The process that holds the lock, as it wrote it down.
std::string holder(int file) {
  std::array<char, 32> text{};
  const ssize_t length = ::pread(file, text.data(), text.size() - 1, 0);
  return length > 0 ? "process " + std::string(text.data(), static_cast<std::size_t>(length)) : "another process";
}

}  // namespace

std::string DeviceLock::path_for(const std::string& serial) {
  std::string name = "gravure-";
  for (const char letter : serial) {
    const bool plain = (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'z') ||
                       (letter >= 'A' && letter <= 'Z') || letter == '-';
    name += plain ? letter : '_';
  }
  std::error_code failed;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(failed);
  return ((failed ? std::filesystem::path(".") : folder) / (name + ".lock")).string();
}

Result<DeviceLock> DeviceLock::take(const std::string& path) {
  const auto failed = [&path](const char* what) {
    return Error{ErrorCode::io, path + ": " + what + ": " + std::strerror(errno) +
                                    ": two runs on one device are kept apart by this file; check its folder"};
  };
  int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0 && errno == ENOENT) {
    file = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_CREAT, kEverybody);
    if (file >= 0) {
      static_cast<void>(::fchmod(file, kEverybody));
    }
  }
  if (file < 0) {
    return failed("cannot open");
  }
  DeviceLock lock(file);
  if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) {
      return failed("cannot lock");
    }
    return Error{ErrorCode::device,
                 "the device is in use by " + holder(file) + " (" + path + "): wait until it has ended, or stop it"};
  }
  const std::string own = std::to_string(::getpid());
  static_cast<void>(!::ftruncate(file, 0));
  static_cast<void>(!::pwrite(file, own.data(), own.size(), 0));
  return lock;
}

DeviceLock::DeviceLock(DeviceLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

DeviceLock& DeviceLock::operator=(DeviceLock&& other) noexcept {
  std::swap(file_, other.file_);
  return *this;
}

DeviceLock::~DeviceLock() {
  if (file_ >= 0) {
    ::close(file_);
  }
}

}  // namespace gravure::session
