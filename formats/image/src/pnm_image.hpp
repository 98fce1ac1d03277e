#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gravure/core/image_source.hpp"

namespace gravure {

/// Opens the one page of a binary PBM (P4) or PGM (P5) file. Bits stay packed; rows are read where they lie, so memory
/// is one row at most. Fails with bad_file: plain text variants (P1, P2), colour (P3, P6), a maximum other than 255 or
/// 65535 (samples would have to be rescaled), sizes beyond the file or kMaxTiffRowBytes a row, more than one image.
Result<std::unique_ptr<ImageSource>> open_pnm(const std::string& path, std::int64_t page);

}  // namespace gravure
