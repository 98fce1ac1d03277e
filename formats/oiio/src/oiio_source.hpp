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

 private:
  Result<void> read_unguarded(std::int64_t first_row, std::int64_t row_count, std::byte* out);
  Result<void> read_scan_lines(std::int64_t first_row, std::int64_t row_count, std::byte* out);
  Result<void> read_tile_rows(std::int64_t first_row, std::int64_t row_count, std::byte* out);
  Result<void> fill_band(std::int64_t index);
  /// Rows as OpenImageIO gives them become rows as ImageSource promises them.
  Result<void> deliver(const std::byte* rows, std::int64_t first_row, std::int64_t row_count, std::byte* out) const;
  Error damage(std::int64_t first_row, std::int64_t row_count) const;
  std::string place() const;

  std::unique_ptr<OIIO::ImageInput> input_;
  ImageInfo info_;
  bool tiled_;
  std::int64_t row_bytes_;          // of a row given
  std::int64_t samples_row_bytes_;  // of a row as OpenImageIO gives it: a byte for each bit
  std::vector<std::byte> rows_;     // scan lines on their way to bits
  std::vector<std::byte> band_;     // the latest row of tiles
  std::int64_t band_index_ = -1;
};

/// The type OpenImageIO is asked to deliver.
OIIO::TypeDesc delivered_type(SampleType samples);

}  // namespace gravure::oiio
