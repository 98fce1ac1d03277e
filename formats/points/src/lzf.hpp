#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "gravure/core/error.hpp"

namespace gravure {

/// LZF as PCD files use it: literal runs and copies of what was written before. bad_file unless exactly `size` bytes
/// come out; the error says what is wrong, the caller where.
Result<std::string> lzf_unpacked(std::string_view packed, std::size_t size);

}  // namespace gravure
