#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "gravure/core/error.hpp"

// What the fuzz targets of readers of text files have in common.

namespace gravure::fuzz {

inline constexpr std::string_view kPath = "fuzz.toml";

inline void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

/// Its kind is that of a bad file, every line begins with the path, and nothing in it moves a terminal's cursor.
inline void check_error(const Error& error) {
  require(error.code == ErrorCode::bad_argument || error.code == ErrorCode::out_of_range ||
          error.code == ErrorCode::bad_file);
  require(error.message.compare(0, kPath.size(), kPath) == 0);
  for (std::size_t at = 0; at < error.message.size(); ++at) {
    if (error.message[at] == '\n') {
      require(error.message.compare(at + 1, kPath.size(), kPath) == 0);
    }
    require(error.message[at] == '\n' || static_cast<unsigned char>(error.message[at]) >= 0x20U);
  }
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace gravure::fuzz
