#pragma once

#include <cstdint>
#include <string>

#include "gravure/core/error.hpp"

namespace gravure {

/// The families of files gravure reads, told apart by their first bytes, never by their names.
enum class ImageKind : std::uint8_t { tiff, png, bmp, openexr, pnm };

/// Fails with bad_file where the file is missing, no regular file, or of none of these kinds.
Result<ImageKind> image_kind(const std::string& path);

/// "TIFF", "PNG", "BMP", "OpenEXR", "PBM/PGM".
const char* image_kind_name(ImageKind kind) noexcept;

}  // namespace gravure
