#pragma once

#include <hdf5.h>

#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/program.hpp"

namespace gravure::grv {

/// /sources and /files: one row a file, {path, page, width, height, sha256}; the path is as wide as the longest needs.
/// Called within an Hdf5Session. bad_argument for a NUL in a text or a hash longer than 64 characters.
Result<void> write_sources(hid_t file, const char* name, const std::vector<SourceImage>& sources);
Result<std::vector<SourceImage>> read_sources(hid_t file, const char* name);

}  // namespace gravure::grv
