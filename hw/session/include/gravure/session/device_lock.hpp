#pragma once

#include <string>

#include "gravure/core/error.hpp"

namespace gravure::session {

/// One run on one device: a file that is locked as long as this lives, or its process does.
class DeviceLock {
 public:
  /// device where another run holds it, naming its process; io where the file cannot be made.
  static Result<DeviceLock> take(const std::string& path);
  /// The file for a board that is known by its serial number alone, in the folder for temporary files.
  static std::string path_for(const std::string& serial);

  DeviceLock(DeviceLock&& other) noexcept;
  DeviceLock& operator=(DeviceLock&& other) noexcept;
  ~DeviceLock();

 private:
  explicit DeviceLock(int file) : file_(file) {}
  int file_ = -1;
};

}  // namespace gravure::session
