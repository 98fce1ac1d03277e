#include "point_text.hpp"

#include <algorithm>
#include <charconv>

namespace gravure {
namespace {

bool is_blank(char c) noexcept {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
}

}  // namespace

std::string_view TextWords::next() {
  std::size_t begin = 0;
  while (begin < rest_.size() && is_blank(rest_[begin])) {
    line_ += rest_[begin] == '\n' ? 1 : 0;
    ++begin;
  }
  std::size_t end = begin;
  while (end < rest_.size() && !is_blank(rest_[end])) {
    ++end;
  }
  const std::string_view word = rest_.substr(begin, end - begin);
  rest_.remove_prefix(end);
  return word;
}

void TextWords::skip_line() {
  const std::size_t end = rest_.find('\n');
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end);
}

std::string_view take_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  return line;
}

bool to_number(std::string_view word, double& value) {
  if (word.starts_with('+') && !word.starts_with("+-")) {
    word.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size() && !word.empty();
}

bool to_count(std::string_view word, std::uint64_t& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size() && !word.empty();
}

std::string in_quotes(std::string_view word) {
  std::string text(word.substr(0, 40));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; }, '?');
  return '"' + text + '"';
}

Error bad_line(const std::string& name, std::int64_t line, const std::string& what) {
  return {ErrorCode::bad_file, name + ": line " + std::to_string(line) + ": " + what};
}

Error bad_byte(const std::string& name, std::size_t byte, const std::string& what) {
  return {ErrorCode::bad_file, name + ": byte " + std::to_string(byte) + ": " + what};
}

}  // namespace gravure
