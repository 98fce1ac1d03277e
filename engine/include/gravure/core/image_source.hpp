#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "gravure/core/error.hpp"

namespace gravure {

enum class SampleType : std::uint8_t { bit, u8, u16, f32 };

/// What the header of one image (one page of a file) says.
struct ImageInfo {
  std::string path;
  std::int64_t page = 0;
  std::int64_t width = 0;   ///< pixels
  std::int64_t height = 0;  ///< rows
  SampleType samples = SampleType::bit;
  bool zero_is_white = false;           ///< bit images: raw bit 0 means white (TIFF MinIsWhite)
  std::int64_t rows_per_block = 1;      ///< strip or tile height: reading whole blocks is cheapest
  bool random_access = true;            ///< false: rows must be read upwards from 0 (one giant strip)
  std::int64_t decoder_bytes = 0;       ///< the most its reader holds beside the rows it gives: blocks, codec, tables
  bool fax_larger_than_raw = false;     ///< CCITT data beyond the bits they stand for: dithered, very slow to decode
  std::optional<double> x_dots_per_mm;  ///< physical size tag, where there is one
  std::optional<double> y_dots_per_mm;
};

/// Bytes of one row as read_rows() gives it: bits packed MSB first, or samples in host byte order.
constexpr std::int64_t row_bytes(SampleType samples, std::int64_t width) {
  switch (samples) {
    case SampleType::bit:
      return (width + 7) / 8;
    case SampleType::u8:
      return width;
    case SampleType::u16:
      return width * 2;
    case SampleType::f32:
      return width * 4;
  }
  return 0;
}

/// One image, read in blocks of rows and never whole. Not thread-safe: each worker opens its own.
class ImageSource {
 public:
  virtual ~ImageSource() = default;
  virtual const ImageInfo& info() const noexcept = 0;
  /// Reads rows [first_row, first_row + row_count) into `out` (row_count * row_bytes(), rows without padding).
  /// Bits beyond the width in a row's last byte are undefined. Fails with bad_file where the file is damaged or short.
  virtual Result<void> read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) = 0;
};

/// Opens images of some family of formats.
class ImageOpener {
 public:
  virtual ~ImageOpener() = default;
  /// Number of pages in a file.
  virtual Result<std::int64_t> count_pages(const std::string& path) const = 0;
  /// Opens one page and reads its header. Colour, and sample types not in SampleType, are bad_file.
  virtual Result<std::unique_ptr<ImageSource>> open(const std::string& path, std::int64_t page) const = 0;
};

}  // namespace gravure
