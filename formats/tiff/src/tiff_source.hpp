#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "gravure/core/image_source.hpp"
#include "tiff_handle.hpp"
#include "tiff_page_info.hpp"

namespace gravure {

/// Strips and tiles as stored. Those that lie one behind the other are fetched together: libtiff seeks and reads for
/// each alone, which is a tenth of the time that small ones take.
class StoredBlocks {
 public:
  static constexpr std::int64_t kBytes = std::int64_t{64} << 10;

  /// A block, until the next call; null where it is too large to be held here or cannot be read. Each byte is given out
  /// once, then read anew: decoders may write to it (JBIG turns its bits round and leaves them so).
  std::byte* get(int file, std::int64_t offset, std::int64_t bytes);

 private:
  bool fetch(int file, std::int64_t offset, std::int64_t bytes);

  std::unique_ptr<std::byte[]> held_;
  std::int64_t held_from_byte_ = 0;  // of the file
  std::int64_t next_byte_ = 0;       // the first that was not given out
  std::int64_t end_byte_ = 0;
};

/// What all ways of reading share: the handle, the checks of a call, the wording of damage.
class BilevelSource : public ImageSource {
 public:
  BilevelSource(TiffHandle handle, ImageInfo info);
  const ImageInfo& info() const noexcept override { return info_; }
  Result<void> read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) final;

 protected:
  virtual Result<void> read_checked(std::int64_t first_row, std::int64_t row_count, std::byte* out) = 0;

  TIFF* tiff() const noexcept { return handle_.get(); }
  void clear_messages() noexcept {
    handle_.messages().clear();
    errno = 0;
  }
  /// A warning while decoding means that libtiff filled in what it could not read: damage all the same.
  bool said_anything() const noexcept { return handle_.messages().any(); }
  std::string place() const { return tiff_place(info_.path, info_.page); }
  /// Of a row that could not be read since clear_messages(): io where the device failed, else bad_file.
  Error damage(std::int64_t row) const;
  /// Decodes a strip or tile of `bytes` bytes; false where it is damaged.
  bool decode_block(std::uint32_t number, std::byte* out, std::int64_t bytes);
  /// Bits as the file has them, turned to the highest first; returns how many bytes there were.
  std::int64_t read_bytes(std::int64_t offset, std::int64_t bytes, std::byte* out, bool lowest_bit_first) const;

  TiffHandle handle_;
  ImageInfo info_;
  std::int64_t row_bytes_;

 private:
  StoredBlocks blocks_;
};

/// The ways of reading a bilevel page.
Result<std::unique_ptr<ImageSource>> make_tile_source(TiffHandle handle, ImageInfo info, const TiffPageInfo& page_info);
std::unique_ptr<ImageSource> make_strip_source(TiffHandle handle, ImageInfo info, const TiffPageInfo& page_info);

}  // namespace gravure
