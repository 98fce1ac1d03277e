#include "gravure/formats/image_files.hpp"

#include "gravure/formats/image_kind.hpp"
#include "import_loader.hpp"
#include "pnm_image.hpp"

namespace gravure {

ImageFiles::ImageFiles() : module_(std::make_unique<ImportLoader>()) {}
ImageFiles::~ImageFiles() = default;

Result<std::int64_t> ImageFiles::count_pages(const std::string& path) const {
  GRAVURE_TRY(const ImageKind kind, image_kind(path));
  if (kind == ImageKind::tiff) {
    return tiff_.count_pages(path);
  }
  if (kind == ImageKind::pnm) {
    return std::int64_t{1};
  }
  GRAVURE_TRY(const ImageOpener* const opener, module_->opener(path));
  return opener->count_pages(path);
}

Result<std::unique_ptr<ImageSource>> ImageFiles::open(const std::string& path, std::int64_t page) const {
  GRAVURE_TRY(const ImageKind kind, image_kind(path));
  if (kind == ImageKind::tiff) {
    GRAVURE_TRY(const TiffPageInfo info, tiff_.read_page_info(path, page));
    if (info.bilevel()) {
      return tiff_.open(path, page);
    }
  }
  if (kind == ImageKind::pnm) {
    return open_pnm(path, page);
  }
  GRAVURE_TRY(const ImageOpener* const opener, module_->opener(path));
  return opener->open(path, page);
}

}  // namespace gravure
