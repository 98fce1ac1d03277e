#include "oiio_source.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <exception>
#include <new>
#include <utility>

#include "pack_bits.hpp"
#include "row_request.hpp"

namespace gravure::oiio {
namespace {

constexpr std::int64_t kRowsBytes = std::int64_t{1} << 20;  // scan lines unpacked at a time

/// The type tiles are asked for.
OIIO::TypeDesc delivered_type(SampleType samples) {
  return samples == SampleType::u16 ? OIIO::TypeUInt16 : samples == SampleType::f32 ? OIIO::TypeFloat : OIIO::TypeUInt8;
}

/// Bytes of a row as OpenImageIO gives it.
std::int64_t samples_row(const ImageInfo& info, bool half) {
  return info.samples == SampleType::bit ? info.width : row_bytes(info.samples, info.width) / (half ? 2 : 1);
}

bool in_blocks(const HeaderFacts& facts) {
  return facts.tiled || (facts.random_access && facts.rows_per_block > 1 && facts.stored_in_strips);
}

}  // namespace

OiioSource::OiioSource(std::unique_ptr<OIIO::ImageInput> input, ImageInfo info, const HeaderFacts& facts)
    : input_(std::move(input)),
      info_(std::move(info)),
      tiled_(facts.tiled),
      blocks_(in_blocks(facts)),
      half_(!facts.tiled && input_->spec().format == OIIO::TypeHalf),
      first_x_(input_->spec().x),
      first_y_(input_->spec().y),
      row_bytes_(row_bytes(info_.samples, info_.width)),
      samples_row_bytes_(samples_row(info_, half_)) {}

std::int64_t OiioSource::buffer_bytes(const ImageInfo& info, const HeaderFacts& facts) {
  const std::int64_t row = std::max(row_bytes(info.samples, info.width), info.width);
  return in_blocks(facts) ? info.rows_per_block * row : std::max(kRowsBytes, row);
}

Result<void> OiioSource::read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) {
  GRAVURE_CHECK(check_rows(info_, first_row, row_count, out.size()));
  errno = 0;
  try {
    return read_unguarded(first_row, row_count, out.data());
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::io, place_of(info_) + "out of memory while reading: lower --memory or --threads"};
  } catch (const std::exception& failure) {
    return Error{ErrorCode::bad_file, place_of(info_) + "cannot be read: " + failure.what()};
  }
}

Result<void> OiioSource::read_unguarded(std::int64_t first_row, std::int64_t row_count, std::byte* out) {
  return blocks_ ? read_blocks(first_row, row_count, out) : read_scan_lines(first_row, row_count, out);
}

bool OiioSource::read_native(std::int64_t first_row, std::int64_t row_count, std::byte* out) {
  const int first = first_y_ + static_cast<int>(first_row);
  return input_->read_native_scanlines(static_cast<int>(info_.page), 0, first, first + static_cast<int>(row_count), 0,
                                       0, 1, out);
}

Result<void> OiioSource::read_scan_lines(std::int64_t first_row, std::int64_t row_count, std::byte* out) {
  const std::int64_t at_once = std::max<std::int64_t>(1, kRowsBytes / samples_row_bytes_);
  const bool direct = samples_row_bytes_ == row_bytes_ && info_.samples != SampleType::bit;
  rows_.resize(direct ? 0 : static_cast<std::size_t>(at_once * samples_row_bytes_));
  for (std::int64_t done = 0; done < row_count;) {
    const std::int64_t row = first_row + done;
    const std::int64_t rows = std::min(at_once, row_count - done);
    std::byte* const target = direct ? out + done * row_bytes_ : rows_.data();
    if (!read_native(row, rows, target)) {
      return damaged_rows(info_, row, rows, input_->geterror());
    }
    GRAVURE_CHECK(deliver(target, row, rows, out + done * row_bytes_));
    done += rows;
  }
  return {};
}

Result<void> OiioSource::read_blocks(std::int64_t first_row, std::int64_t row_count, std::byte* out) {
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
  const int y = first_y_ + static_cast<int>(first);
  const bool read = tiled_ ? input_->read_tiles(static_cast<int>(info_.page), 0, first_x_,
                                                first_x_ + static_cast<int>(info_.width), y, y + static_cast<int>(rows),
                                                0, 1, 0, 1, delivered_type(info_.samples), band_.data())
                           : read_native(first, rows, band_.data());
  if (!read) {
    return damaged_rows(info_, first, rows, input_->geterror());
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
  if (half_) {
    OIIO::convert_pixel_values(OIIO::TypeHalf, rows, OIIO::TypeFloat, out, static_cast<int>(row_count * info_.width));
  } else if (rows != out) {
    std::memcpy(out, rows, static_cast<std::size_t>(row_count * row_bytes_));
  }
  return info_.samples == SampleType::f32 ? check_finite(out, first_row, row_count) : Result<void>();
}

Result<void> OiioSource::check_finite(const std::byte* out, std::int64_t first_row, std::int64_t row_count) const {
  for (std::int64_t i = 0; i < row_count * info_.width; ++i) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, out + i * 4, 4);
    if ((bits & 0x7F800000U) == 0x7F800000U) {
      return Error{ErrorCode::bad_file, place_of(info_) + "row " + std::to_string(first_row + i / info_.width) +
                                            ", column " + std::to_string(i % info_.width) +
                                            ": the sample is not a finite number: a depth map has a depth everywhere; "
                                            "fill the gap"};
    }
  }
  return {};
}

}  // namespace gravure::oiio
