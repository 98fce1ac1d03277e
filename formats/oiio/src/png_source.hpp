#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gravure/core/image_source.hpp"

namespace gravure::oiio {

class PngDecoder;

/// Rows of a grey PNG whose chunks were found whole (read_png_header()), straight from libpng. OpenImageIO's reader
/// lets libpng print what it finds wrong in the compressed data; here that is part of the error and stands nowhere
/// else.
class PngSource final : public ImageSource {
 public:
  explicit PngSource(ImageInfo info);
  ~PngSource() override;

  const ImageInfo& info() const noexcept override { return info_; }
  Result<void> read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) override;

 private:
  Result<void> begin();

  ImageInfo info_;
  std::unique_ptr<PngDecoder> decoder_;  // none before the first row, and after damage
  std::int64_t next_row_ = 0;
  std::vector<std::byte> skipped_;  // a row on the way to the first one asked for
};

/// What libpng finds wrong before the first row: chunks out of order, unknown ones that are needed.
Result<void> check_png_start(const std::string& path);

}  // namespace gravure::oiio
