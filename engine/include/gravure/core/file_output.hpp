#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "gravure/core/error.hpp"

namespace gravure {

/// A file that appears whole or not at all: write to temporary_path(), then commit() syncs and renames it.
/// Destroyed before commit(), it removes the temporary file.
class FileOutput {
 public:
  /// Reserves a temporary name in the folder of `path`. Fails with io when the folder is missing or not writable.
  static Result<FileOutput> create(const std::string& path);
  FileOutput(FileOutput&& other) noexcept;
  FileOutput& operator=(FileOutput&& other) noexcept;
  FileOutput(const FileOutput&) = delete;
  FileOutput& operator=(const FileOutput&) = delete;
  ~FileOutput();

  const std::string& temporary_path() const noexcept { return temporary_; }
  const std::string& path() const noexcept { return path_; }
  /// Whether this process has a file in its place or a temporary one on the way: ending now would leave something
  /// behind. A signal handler may ask.
  static bool any_begun() noexcept;
  /// All that was written, on the disk: what is left of commit() then seldom fails. Of files that come together, each
  /// before the first commit().
  Result<void> sync();
  Result<void> commit();

 private:
  FileOutput(std::string path, std::string temporary);
  void discard() noexcept;
  std::string path_;
  std::string temporary_;
  bool synced_ = false;
};

/// All of `content` on the disk, but not in its place before commit().
Result<FileOutput> stage_file(const std::string& path, std::string_view content);
/// Writes `content` to `path`, whole or not at all.
Result<void> write_file(const std::string& path, std::string_view content);
/// Why an input could not be opened, from errno: bad_file where the user can mend it (not there, not allowed, no file
/// at all), io where the system fails.
Error open_error(const std::string& path, int reason);
/// As many bytes from `offset` on as there are, at most all of `out`, whatever signals come; -1, with errno, where
/// reading fails.
std::int64_t read_file_at(int file, std::int64_t offset, std::span<std::byte> out) noexcept;
/// Reading failed for `reason`, of errno: io. `where` names the file and the place in it.
Error read_error(const std::string& where, int reason);
/// Whether errno, after a library has failed to read a file, says that the device or the network did, not that the file
/// is short or wrong.
bool is_device_failure(int reason) noexcept;
/// Reads a file of at most `max_bytes`; bad_file beyond or where it cannot be opened, io where reading breaks off.
Result<std::string> read_file(const std::string& path, std::size_t max_bytes);

}  // namespace gravure
