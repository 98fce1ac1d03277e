#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "gravure/core/error.hpp"

namespace gravure::grv {

/// Bytes at offsets: a file, or an image in memory for tests. Safe to read from several threads.
class ByteFile {
 public:
  virtual ~ByteFile() = default;
  virtual const std::string& path() const noexcept = 0;
  virtual Result<std::uint64_t> size() const = 0;
  /// Reads up to out.size() bytes; fewer only where the file ends.
  virtual Result<std::size_t> read(std::uint64_t offset, std::span<std::byte> out) const = 0;
  /// May keep the bytes back until flush(); read() and size() know them already.
  virtual Result<void> write(std::uint64_t offset, std::span<const std::byte> bytes) = 0;
  virtual Result<void> resize(std::uint64_t bytes) = 0;
  /// Gives the operating system what was kept back.
  virtual Result<void> flush() = 0;
};

enum class OpenFor : std::uint8_t { reading, writing };

/// Opens an existing regular file; one for writing is used by one thread at a time. Messages name `shown_path`.
Result<std::unique_ptr<ByteFile>> open_file(const std::string& path, OpenFor purpose, const std::string& shown_path);
/// A read-only view of bytes that outlive it.
std::unique_ptr<ByteFile> open_image(std::span<const std::byte> image);

/// Reads all of `out`, or bad_file saying that the file ends early.
Result<void> read_exactly(const ByteFile& file, std::uint64_t offset, std::span<std::byte> out);

}  // namespace gravure::grv
