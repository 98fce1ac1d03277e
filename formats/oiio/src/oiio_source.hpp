#pragma once

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "gravure/core/image_source.hpp"
#include "header_facts.hpp"

namespace gravure::oiio {

/// One page of an open OpenImageIO input, standing on it.
class OiioSource final : public ImageSource {
 public:
  OiioSource(std::unique_ptr<OIIO::ImageInput> input, ImageInfo info, const HeaderFacts& facts);

  const ImageInfo& info() const noexcept override { return info_; }
  Result<void> read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) override;
  /// The most that such a source keeps itself.
  static std::int64_t buffer_bytes(const ImageInfo& info, const HeaderFacts& facts);

 private:
  Result<void> read_unguarded(std::int64_t first_row, std::int64_t row_count, std::byte* out);
  Result<void> read_scan_lines(std::int64_t first_row, std::int64_t row_count, std::byte* out);
  Result<void> read_blocks(std::int64_t first_row, std::int64_t row_count, std::byte* out);
  Result<void> fill_band(std::int64_t index);
  /// Scan lines as the file has them. OpenImageIO's other calls take 64 MiB to convert, and decode whole strips.
  bool read_native(std::int64_t first_row, std::int64_t row_count, std::byte* out);
  /// Rows as OpenImageIO gives them become rows as ImageSource promises them.
  Result<void> deliver(const std::byte* rows, std::int64_t first_row, std::int64_t row_count, std::byte* out) const;
  Result<void> check_finite(const std::byte* out, std::int64_t first_row, std::int64_t row_count) const;

  std::unique_ptr<OIIO::ImageInput> input_;
  ImageInfo info_;
  bool tiled_;
  bool blocks_;  // whole strips or rows of tiles are read
  bool half_;    // half samples come as they are
  int first_x_;  // where OpenImageIO says that the picture begins
  int first_y_;
  std::int64_t row_bytes_;          // of a row given
  std::int64_t samples_row_bytes_;  // of a row as OpenImageIO gives it: a byte for each bit, halves
  std::vector<std::byte> rows_;     // scan lines on their way to bits or floats
  std::vector<std::byte> band_;     // the latest strip or row of tiles
  std::int64_t band_index_ = -1;
};

}  // namespace gravure::oiio
