#include "nc_words.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace gravure::nc {

std::string number(double value) {
  std::string text = fmt::format("{:.9f}", value == 0 ? 0.0 : value);
  return text == "-0.000000000" ? "0.000000000" : text;
}

std::string comment(std::string_view text) {
  std::string safe;
  for (const char c : text.substr(0, 100)) {
    safe += c == '(' || c == ')' || static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return safe;
}

bool LineReader::next() {
  while (!text_.empty()) {
    const std::size_t end = text_.find('\n');
    line_ = text_.substr(0, end);
    text_ = end == std::string_view::npos ? std::string_view() : text_.substr(end + 1);
    ++number_;
    if (!line_.empty() && line_.front() != '(' && line_.front() != ';') {
      return true;
    }
  }
  line_ = {};
  return false;
}

bool LineReader::take(std::string_view word) {
  if (!line_.starts_with(word)) {
    return false;
  }
  line_.remove_prefix(word.size());
  return true;
}

std::optional<double> LineReader::take_number() {
  double value = 0;
  const auto [end, failed] = std::from_chars(line_.data(), line_.data() + line_.size(), value);
  if (failed != std::errc() || !std::isfinite(value)) {
    return std::nullopt;
  }
  line_.remove_prefix(static_cast<std::size_t>(end - line_.data()));
  return value;
}

Error LineReader::bad(const std::string& why) const {
  return {ErrorCode::bad_file, "line " + std::to_string(number_) + ": " + why};
}

}  // namespace gravure::nc
