#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "gravure/core/error.hpp"
#include "gravure/formats/tiff.hpp"
#include "tiff_handle.hpp"
#include "tiff_page_offsets.hpp"

namespace gravure {

inline constexpr std::int64_t kMaxTiffHeight = std::numeric_limits<std::int32_t>::max();

/// "path: page 3: "
std::string tiff_place(const std::string& path, std::int64_t page);

/// Opens a TIFF standing on one page. No mmap, so that memory stays bounded whatever the file size.
Result<TiffHandle> open_tiff_page(const std::string& path, std::int64_t page, const TiffPageList& pages);

/// Reads and checks the directory the handle stands on (see TiffPageInfo).
Result<TiffPageInfo> inspect_tiff_page(const TiffHandle& handle, const std::string& path, std::int64_t page,
                                       std::uint64_t file_bytes);

}  // namespace gravure
