#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gravure/core/image_source.hpp"
#include "gravure/formats/tiff.hpp"

namespace gravure::oiio {

/// Reads grey and bilevel TIFF, PNG, BMP and OpenEXR through OpenImageIO. Only one channel, only 1, 8 or 16 bits or
/// half and float samples; anything that would have to be guessed is refused. No exception leaves it. Thread-safe.
class OiioOpener final : public ImageOpener {
 public:
  OiioOpener();
  Result<std::int64_t> count_pages(const std::string& path) const override;
  Result<std::unique_ptr<ImageSource>> open(const std::string& path, std::int64_t page) const override;

 private:
  Result<std::int64_t> count_unguarded(const std::string& path) const;
  Result<std::unique_ptr<ImageSource>> open_unguarded(const std::string& path, std::int64_t page) const;
  BilevelTiffOpener tiff_;  // for its page table and its checks
};

}  // namespace gravure::oiio
