#include "rotary_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

template <std::size_t N>
bool holds(const std::array<double, N>& codes, double code) noexcept {
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

/// Codes that leave a line what it looks like. Missing are arcs and cycles, G10, G20, G28, G30, G52, G53, G65, G68,
/// G91, G92 and their like.
bool plain_g(double code, bool moved) noexcept {
  static constexpr std::array<double, 21> kPlain{0,    1,  4,  17, 18,   19,   21, 40, 43, 49, 61,
                                                 61.1, 64, 80, 90, 90.1, 91.1, 93, 94, 97, 98};
  const bool offset = code >= 54 && code < 60;
  return holds(kPlain, code) || (offset && !moved);
}

/// Calls of other programs, which may move anything.
bool calls(double code) noexcept {
  static constexpr std::array<double, 3> kCalls{97, 98, 99};
  return holds(kCalls, code);
}

/// The first thing on a line that is not plain; empty if there is none.
std::string_view foreign(std::string_view line, const std::vector<Word>& words, bool moved) noexcept {
  const std::size_t formula = line.find_first_of("#<[");
  if (formula < line.find_first_of("(;")) {
    return line.substr(formula, 1);
  }
  for (const Word& word : words) {
    const bool axis = std::string_view("XYZAC").find(word.letter) != std::string_view::npos;
    const bool again = axis && std::count_if(words.begin(), words.end(),
                                             [&word](const Word& other) { return other.letter == word.letter; }) > 1;
    const bool other_axis = std::string_view("BUVWO").find(word.letter) != std::string_view::npos;
    if (again || other_axis || (word.letter == 'G' && !plain_g(word.value, moved)) ||
        (word.letter == 'M' && calls(word.value))) {
      return line.substr(word.begin, word.end - word.begin);
    }
  }
  return {};
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

Result<void> check_plain(std::string_view line, std::size_t number, const std::vector<Word>& words, bool moved) {
  const std::string_view found = foreign(line, words, moved);
  if (found.empty()) {
    return {};
  }
  return Error{ErrorCode::bad_file,
               fmt::format("rotary program: line {}: {}: only straight moves of X, Y, Z, A and C in absolute mm and "
                           "degrees are read (G90, G21); have the post-processor write such",
                           number, found)};
}

}  // namespace gravure::motion
