#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "byte_file.hpp"
#include "gravure/core/error.hpp"

namespace gravure::grv {

/// The way between the HDF5 library and a file of ours: an HDF5 file driver that reads and writes a ByteFile. It knows
/// where the library puts a buffer (the seal and the reader need the places of the chunks, and HDF5 1.10 finds them
/// only by walking all of them). And it never tells the library that a write has failed: HDF5 1.10 then keeps a
/// half-closed file and crashes when the process ends. The failure is kept for whoever wrote, later writes are dropped.
class Hdf5Channel {
 public:
  explicit Hdf5Channel(std::unique_ptr<ByteFile> file) : file_(std::move(file)) {}

  ByteFile& file() noexcept { return *file_; }
  const ByteFile& file() const noexcept { return *file_; }

  /// Notes the file offset at which `buffer` will be written.
  void watch(const void* buffer) noexcept;
  std::optional<std::uint64_t> watched_offset() const noexcept { return watched_offset_; }
  /// From now on nothing reaches the file.
  void abandon() noexcept { abandoned_ = true; }
  /// Why the operating system refused to read or write, where it did. To be asked after every call that may write.
  const std::optional<Error>& failure() const noexcept { return failure_; }

  // Called by the driver.
  bool read(std::uint64_t offset, void* buffer, std::size_t bytes) noexcept;
  void write(std::uint64_t offset, const void* buffer, std::size_t bytes) noexcept;
  void resize(std::uint64_t bytes) noexcept;

 private:
  void settle(const Result<void>& done) noexcept;
  std::unique_ptr<ByteFile> file_;
  const void* watched_ = nullptr;
  std::optional<std::uint64_t> watched_offset_;
  std::optional<Error> failure_;
  bool abandoned_ = false;
};

/// Makes `access`, a file access property list, open files through `channel`, which must stay in place until
/// H5Fcreate() or H5Fopen() returns; the HDF5 file then shares it. Call within an Hdf5Session. False on failure.
bool set_channel(hid_t access, const std::shared_ptr<Hdf5Channel>& channel);

}  // namespace gravure::grv
