#include "tiff_source.hpp"

#include <algorithm>
#include <utility>

#include "gravure/core/file_output.hpp"

namespace gravure {

std::byte* StoredBlocks::get(int file, std::int64_t offset, std::int64_t bytes) {
  if (bytes > kBytes) {
    return nullptr;
  }
  if (offset < next_byte_ || offset + bytes > end_byte_) {
    const bool goes_on = end_byte_ > 0 && offset >= next_byte_ && offset <= end_byte_;  // who jumps about wants no more
    if (!fetch(file, offset, goes_on ? kBytes : bytes) || offset + bytes > end_byte_) {
      return nullptr;
    }
  }
  next_byte_ = offset + bytes;
  return held_.get() + (offset - held_from_byte_);
}

bool StoredBlocks::fetch(int file, std::int64_t offset, std::int64_t bytes) {
  if (!held_) {
    held_ = std::make_unique_for_overwrite<std::byte[]>(static_cast<std::size_t>(kBytes));
  }
  const std::int64_t got = read_file_at(file, offset, {held_.get(), static_cast<std::size_t>(bytes)});
  held_from_byte_ = next_byte_ = offset;
  end_byte_ = offset + std::max<std::int64_t>(0, got);
  return got > 0;
}

BilevelSource::BilevelSource(TiffHandle handle, ImageInfo info)
    : handle_(std::move(handle)), info_(std::move(info)), row_bytes_(row_bytes(SampleType::bit, info_.width)) {}

Result<void> BilevelSource::read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) {
  if (first_row < 0 || row_count < 0 || row_count > info_.height || first_row > info_.height - row_count) {
    return Error{ErrorCode::out_of_range, place() + "rows " + std::to_string(first_row) + " + " +
                                              std::to_string(row_count) + " asked for: it has rows 0 to " +
                                              std::to_string(info_.height - 1)};
  }
  if (out.size() < static_cast<std::size_t>(row_count * row_bytes_)) {
    return Error{ErrorCode::bad_argument, place() + "the buffer for " + std::to_string(row_count) + " rows holds " +
                                              std::to_string(out.size()) + " bytes, " +
                                              std::to_string(row_count * row_bytes_) + " are needed"};
  }
  return read_checked(first_row, row_count, out.data());
}

Error BilevelSource::damage(std::int64_t row) const {
  const int reason = errno;  // of libtiff's last call of the system, if it made one
  const std::string where = place() + "row " + std::to_string(row);
  if (is_device_failure(reason)) {
    return read_error(where, reason);
  }
  return {ErrorCode::bad_file, where + ": the image data are damaged or truncated; copy or export the file again" +
                                   handle_.messages().text()};
}

bool BilevelSource::decode_block(std::uint32_t number, std::byte* out, std::int64_t bytes) {
  clear_messages();
  const auto offset = static_cast<std::int64_t>(TIFFGetStrileOffset(tiff(), number));
  const auto stored = static_cast<std::int64_t>(TIFFGetStrileByteCount(tiff(), number));
  if (std::byte* const block = blocks_.get(TIFFFileno(tiff()), offset, stored)) {
    return TIFFReadFromUserBuffer(tiff(), number, block, stored, out, bytes) == 1 && !said_anything();
  }
  if (is_device_failure(errno)) {  // where a read fails, libtiff 4.5 clears a byte before its buffer, too
    return false;
  }
  const tmsize_t got = TIFFIsTiled(tiff()) != 0 ? TIFFReadEncodedTile(tiff(), number, out, bytes)
                                                : TIFFReadEncodedStrip(tiff(), number, out, bytes);
  return got == bytes && !said_anything();
}

std::int64_t BilevelSource::read_bytes(std::int64_t offset, std::int64_t bytes, std::byte* out,
                                       bool lowest_bit_first) const {
  const std::int64_t done =
      std::max<std::int64_t>(0, read_file_at(TIFFFileno(tiff()), offset, {out, static_cast<std::size_t>(bytes)}));
  if (lowest_bit_first) {
    TIFFReverseBits(reinterpret_cast<std::uint8_t*>(out), done);
  }
  return done;
}

}  // namespace gravure
