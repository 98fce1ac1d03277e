#include "rotary_words.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace gravure::motion {
namespace {

char capital(char c) noexcept {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

bool blank(char c) noexcept {
  return c == ' ' || c == '\t' || c == '\r';
}

}  // namespace

Result<std::vector<Word>> words_of(std::string_view line, std::size_t number) {
  std::vector<Word> words;
  bool comment = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    comment = comment ? line[i] != ')' : line[i] == '(';
    if (line[i] == ';' && !comment) {
      break;
    }
    const char letter = capital(line[i]);
    if (comment || letter < 'A' || letter > 'Z') {
      continue;
    }
    std::size_t from = i + 1;
    while (from < line.size() && blank(line[from])) {
      ++from;
    }
    from += from < line.size() && line[from] == '+' ? 1 : 0;
    double value = 0;
    const auto [end, error] = std::from_chars(line.data() + from, line.data() + line.size(), value);
    if (error == std::errc{} && std::isfinite(value)) {
      const auto after = static_cast<std::size_t>(end - line.data());
      words.push_back({letter, value, i, after});
      i = after - 1;
    } else if (std::string_view("XYZAC").find(letter) != std::string_view::npos) {
      return Error{ErrorCode::bad_file,
                   fmt::format("rotary program: line {}: word {} has no finite number", number, letter)};
    }
  }
  return words;
}

}  // namespace gravure::motion
