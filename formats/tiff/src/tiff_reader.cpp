#include <algorithm>
#include <utility>

#include "gravure/formats/tiff.hpp"
#include "tiff_handle.hpp"
#include "tiff_page_info.hpp"
#include "tiff_page_offsets.hpp"
#include "tiff_source.hpp"

namespace gravure {
namespace {

ImageInfo image_info(const TiffPageInfo& page_info, const std::string& path, std::int64_t page) {
  ImageInfo info;
  info.path = path;
  info.page = page;
  info.width = page_info.width;
  info.height = page_info.height;
  info.samples = SampleType::bit;
  info.zero_is_white = page_info.zero_is_white;
  info.rows_per_block = std::min(page_info.rows_per_block, page_info.height);
  info.x_dots_per_mm = page_info.x_dots_per_mm;
  info.y_dots_per_mm = page_info.y_dots_per_mm;
  const bool fax = page_info.compression == COMPRESSION_CCITTFAX3 || page_info.compression == COMPRESSION_CCITTFAX4;
  info.fax_larger_than_raw = fax && page_info.all_block_bytes > info.height * row_bytes(SampleType::bit, info.width);
  return info;
}

}  // namespace

BilevelTiffOpener::BilevelTiffOpener() : offsets_(std::make_unique<TiffPageOffsets>()) {}
BilevelTiffOpener::~BilevelTiffOpener() = default;

Result<std::int64_t> BilevelTiffOpener::count_pages(const std::string& path) const {
  GRAVURE_TRY(const auto pages, offsets_->find(path));
  return static_cast<std::int64_t>(pages->offsets.size());
}

Result<TiffPageInfo> BilevelTiffOpener::read_page_info(const std::string& path, std::int64_t page) const {
  GRAVURE_TRY(const auto pages, offsets_->find(path));
  GRAVURE_TRY(const TiffHandle handle, open_tiff_page(path, page, *pages));
  return inspect_tiff_page(handle, path, page, pages->file_bytes);
}

Result<std::unique_ptr<ImageSource>> BilevelTiffOpener::open(const std::string& path, std::int64_t page) const {
  GRAVURE_TRY(const auto pages, offsets_->find(path));
  GRAVURE_TRY(TiffHandle handle, open_tiff_page(path, page, *pages));
  GRAVURE_TRY(const TiffPageInfo page_info, inspect_tiff_page(handle, path, page, pages->file_bytes));
  if (!page_info.bilevel() || page_info.palette) {
    return Error{ErrorCode::bad_file, tiff_place(path, page) + std::to_string(page_info.samples_per_pixel) +
                                          " sample(s) of " + std::to_string(page_info.bits_per_sample) +
                                          " bit(s) a pixel" + (page_info.palette ? ", through a palette" : "") +
                                          ": only one plain bit a pixel is bilevel"};
  }
  ImageInfo info = image_info(page_info, path, page);
  if (page_info.tiled) {
    return make_tile_source(std::move(handle), std::move(info), page_info);
  }
  return make_strip_source(std::move(handle), std::move(info), page_info);
}

Result<bool> is_bilevel_tiff(const std::string& path, std::int64_t page) {
  GRAVURE_TRY(const TiffPageInfo info, BilevelTiffOpener().read_page_info(path, page));
  return info.bilevel();
}

}  // namespace gravure
