#pragma once

#include "gravure/core/image_source.hpp"

namespace gravure::oiio {

/// "FILE: page N: ".
std::string place_of(const ImageInfo& info);
/// Rows that the picture has, and a buffer that holds them.
Result<void> check_rows(const ImageInfo& info, std::int64_t first_row, std::int64_t row_count, std::size_t out_bytes);
/// bad_file: these rows cannot be decoded; `reason` is what the library says of it, if anything.
Error damaged_rows(const ImageInfo& info, std::int64_t first_row, std::int64_t row_count, std::string reason);

}  // namespace gravure::oiio
