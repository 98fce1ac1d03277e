#pragma once

#include <charconv>
#include <cstdint>
#include <string_view>

namespace gravure::emulator {

/// Takes "key" and the number behind it off the front of `text`; false where they are not there.
inline bool take_number(std::string_view& text, std::string_view key, std::int64_t& number) {
  if (text.substr(0, key.size()) != key) {
    return false;
  }
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + key.size(), end, number);
  if (error != std::errc()) {
    return false;
  }
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return true;
}

}  // namespace gravure::emulator
