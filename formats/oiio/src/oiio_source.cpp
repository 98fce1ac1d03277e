#include "oiio_source.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <exception>
#include <utility>

#include "pack_bits.hpp"

namespace gravure::oiio {
namespace {

constexpr std::int64_t kRowsBytes = std::int64_t{1} << 20;  // scan lines unpacked at a time

}  // namespace

OIIO::TypeDesc delivered_type(SampleType samples) {
  switch (samples) {
    case SampleType::u16:
      return OIIO::TypeUInt16;
    case SampleType::f32:
      return OIIO::TypeFloat;
    case SampleType::bit:
    case SampleType::u8:
      break;
  }
  return OIIO::TypeUInt8;
}

OiioSource::OiioSource(std::unique_ptr<OIIO::ImageInput> input, ImageInfo info, const HeaderFacts& facts)
    : input_(std::move(input)),
      info_(std::move(info)),
      tiled_(facts.tiled),
      row_bytes_(row_bytes(info_.samples, info_.width)),
      samples_row_bytes_(info_.samples == SampleType::bit ? info_.width : row_bytes_) {}

std::string OiioSource::place() const {
  return info_.path + ": page " + std::to_string(info_.page) + ": ";
}

Error OiioSource::damage(std::int64_t first_row, std::int64_t row_count) const {
  std::string reason = input_->geterror();
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  return {ErrorCode::bad_file, place() + "row " + std::to_string(first_row) + " to " +
                                   std::to_string(first_row + row_count - 1) +
                                   ": the image data are damaged or truncated; copy or export the file again" +
                                   (reason.empty() ? "" : " (" + reason + ")")};
}

Result<void> OiioSource::read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) {
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
  try {
    return read_unguarded(first_row, row_count, out.data());
  } catch (const std::exception& failure) {
    return Error{ErrorCode::bad_file, place() + "cannot be read: " + failure.what()};
  }
}

Result<void> OiioSource::read_unguarded(std::int64_t first_row, std::int64_t row_count, std::byte* out) {
  return tiled_ ? read_tile_rows(first_row, row_count, out) : read_scan_lines(first_row, row_count, out);
}

Result<void> OiioSource::read_scan_lines(std::int64_t first_row, std::int64_t row_count, std::byte* out) {
  const std::int64_t at_once = std::max<std::int64_t>(1, kRowsBytes / samples_row_bytes_);
  const bool bits = info_.samples == SampleType::bit;
  for (std::int64_t done = 0; done < row_count;) {
    const std::int64_t row = first_row + done;
    // Whole strips in one call where they are asked for whole; a MiB at a time where rows become bits.
    const std::int64_t rows = bits ? std::min(at_once, row_count - done) : row_count - done;
    std::byte* target = out + done * row_bytes_;
    if (bits) {
      rows_.resize(static_cast<std::size_t>(at_once * samples_row_bytes_));
      target = rows_.data();
    }
    if (!input_->read_scanlines(static_cast<int>(info_.page), 0, static_cast<int>(row), static_cast<int>(row + rows), 0,
                                0, 1, delivered_type(info_.samples), target)) {
      return damage(row, rows);
    }
    GRAVURE_CHECK(deliver(target, row, rows, out + done * row_bytes_));
    done += rows;
  }
  return {};
}

Result<void> OiioSource::read_tile_rows(std::int64_t first_row, std::int64_t row_count, std::byte* out) {
  for (std::int64_t done = 0; done < row_count;) {
    const std::int64_t row = first_row + done;
    const std::int64_t index = row / info_.rows_per_block;
    const std::int64_t skip = row - index * info_.rows_per_block;
    const std::int64_t rows = std::min(info_.rows_per_block - skip, row_count - done);
    GRAVURE_CHECK(fill_band(index));
    GRAVURE_CHECK(deliver(band_.data() + skip * samples_row_bytes_, row, rows, out + done * row_bytes_));
    done += rows;
  }
  return {};
}

Result<void> OiioSource::fill_band(std::int64_t index) {
  if (index == band_index_) {
    return {};
  }
  band_index_ = -1;
  const std::int64_t first = index * info_.rows_per_block;
  const std::int64_t rows = std::min(info_.rows_per_block, info_.height - first);
  band_.resize(static_cast<std::size_t>(info_.rows_per_block * samples_row_bytes_));
  if (!input_->read_tiles(static_cast<int>(info_.page), 0, 0, static_cast<int>(info_.width), static_cast<int>(first),
                          static_cast<int>(first + rows), 0, 1, 0, 1, delivered_type(info_.samples), band_.data())) {
    return damage(first, rows);
  }
  band_index_ = index;
  return {};
}

Result<void> OiioSource::deliver(const std::byte* rows, std::int64_t first_row, std::int64_t row_count,
                                 std::byte* out) const {
  if (info_.samples == SampleType::bit) {
    for (std::int64_t i = 0; i < row_count; ++i) {
      pack_bits(reinterpret_cast<const std::uint8_t*>(rows + i * samples_row_bytes_), info_.width,
                out + i * row_bytes_);
    }
    return {};
  }
  if (rows != out) {
    std::memcpy(out, rows, static_cast<std::size_t>(row_count * row_bytes_));
  }
  if (info_.samples == SampleType::f32) {
    for (std::int64_t i = 0; i < row_count * info_.width; ++i) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, out + i * 4, 4);
      if ((bits & 0x7F800000U) == 0x7F800000U) {
        return Error{ErrorCode::bad_file,
                     place() + "row " + std::to_string(first_row + i / info_.width) + ", column " +
                         std::to_string(i % info_.width) +
                         ": the sample is not a finite number: a depth map has a depth everywhere; "
                         "fill the gap"};
      }
    }
  }
  return {};
}

}  // namespace gravure::oiio
