#include "gravure/formats/toml/violations.hpp"

#include <algorithm>

namespace gravure::toml_file {

std::string place(std::string_view path, Location at) {
  return std::string(path) + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": ";
}

std::string one_line(std::string_view text, std::size_t max_bytes) {
  std::size_t length = text.size();
  if (length > max_bytes) {
    length = max_bytes;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) {
      --length;  // never half a character
    }
  }
  std::string shown(text.substr(0, length));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; }, '?');
  return length < text.size() ? shown + "..." : shown;
}

Error Violations::to_error(std::string_view path) const {
  std::vector<Violation> sorted = list_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  Error error{ErrorCode::out_of_range, ""};
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (!sorted[i].is_range) {
      error.code = ErrorCode::bad_argument;
    }
    if (i < kMaxShown) {
      error.message += (i == 0 ? "" : "\n") + place(path, sorted[i].at) + sorted[i].text;
    }
  }
  if (sorted.size() > kMaxShown) {
    error.message += "\n" + std::string(path) + ": and " + std::to_string(sorted.size() - kMaxShown) + " more";
  }
  return error;
}

}  // namespace gravure::toml_file
