#pragma once

#include <cstddef>
#include <string_view>

namespace gravure {

/// How many bytes of UTF-8 byte order mark a text begins with: 3 or 0. Editors on Windows write one.
inline std::size_t byte_order_mark_bytes(std::string_view text) noexcept {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.substr(0, kMark.size()) == kMark ? kMark.size() : 0;
}

/// The text behind it. Every reader of text files passes over it.
inline std::string_view without_byte_order_mark(std::string_view text) noexcept {
  return text.substr(byte_order_mark_bytes(text));
}

}  // namespace gravure
