#include "rotary_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace gravure::motion {
namespace {

constexpr std::string_view kAxes = "XYZAC";

char capital(char c) noexcept {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

bool blank(char c) noexcept {
  return c == ' ' || c == '\t' || c == '\r';
}

bool digit(char c) noexcept {
  return c >= '0' && c <= '9';
}

/// What would make another number of the one before it, or of two numbers one.
bool goes_on(char c) noexcept {
  return digit(c) || c == '.' || c == ',' || c == '+' || c == '-' || capital(c) == 'E';
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

/// A dwell, or the end of motion: whether axes beside it move, and what X means, differs between controls.
bool stands_alone(const Word& word) noexcept {
  return word.letter == 'G' && (word.value == 4 || word.value == 80);
}

/// The words of one line, from left to right.
class WordReader {
 public:
  explicit WordReader(const ProgramLine& line) noexcept : line_(line), text_(line.text) {}

  Result<std::vector<Word>> run() {
    while (at_ < text_.size() && text_[at_] != ';') {
      if (text_[at_] == '(') {
        const std::size_t end = text_.find(')', at_);
        if (end == std::string_view::npos) {
          return error_at(line_, at_, "the comment is not closed: end it with ) on this line");
        }
        at_ = end + 1;
      } else if (blank(text_[at_]) || tape_mark()) {
        ++at_;
      } else {
        GRAVURE_CHECK(take_word());
      }
    }
    return std::move(words_);
  }

 private:
  /// A % alone on its line.
  bool tape_mark() const noexcept {
    return text_[at_] == '%' && std::all_of(text_.begin(), text_.end(), [](char c) { return c == '%' || blank(c); });
  }

  Result<void> take_word() {
    const std::size_t begin = at_;
    const char letter = capital(text_[at_]);
    if (letter < 'A' || letter > 'Z') {
      const bool shown = letter > ' ' && letter < 0x7F;
      return error_at(line_, begin,
                      fmt::format("{} is no letter of a word: only words (a letter and a decimal number) and comments "
                                  "are read; have the post-processor write such",
                                  shown ? fmt::format("\"{}\"", letter)
                                        : fmt::format("byte 0x{:02X}", static_cast<unsigned char>(letter))));
    }
    ++at_;
    while (at_ < text_.size() && blank(text_[at_])) {
      ++at_;
    }
    const std::optional<double> value = take_number();
    if (!value) {
      while (at_ < text_.size() && goes_on(text_[at_])) {
        ++at_;
      }
      constexpr std::size_t kShown = 40;
      return error_at(line_, begin,
                      fmt::format("{}: must be {} and a decimal number such as -12.5, with one point and no exponent; "
                                  "correct the program",
                                  text_.substr(begin, std::min(kShown, at_ - begin)), letter));
    }
    words_.push_back({letter, *value, begin, at_});
    return {};
  }

  /// [+-] digits [. digits], at least one digit, and nothing that goes on.
  std::optional<double> take_number() noexcept {
    const std::size_t from = at_ + (at_ < text_.size() && text_[at_] == '+' ? 1 : 0);
    const bool two_signs = from > at_ && from < text_.size() && text_[from] == '-';
    double value = 0;
    const auto [end, error] =
        std::from_chars(text_.data() + from, text_.data() + text_.size(), value, std::chars_format::fixed);
    if (error != std::errc{} || two_signs || !std::isfinite(value)) {
      return std::nullopt;
    }
    at_ = static_cast<std::size_t>(end - text_.data());
    return at_ < text_.size() && goes_on(text_[at_]) ? std::nullopt : std::optional(value);
  }

  const ProgramLine& line_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<Word> words_;
};

/// The first word of a line that is not plain.
const Word* foreign(const std::vector<Word>& words, bool moved) noexcept {
  for (const Word& word : words) {
    const bool axis = kAxes.find(word.letter) != std::string_view::npos;
    const bool again = axis && std::count_if(words.begin(), words.end(),
                                             [&word](const Word& other) { return other.letter == word.letter; }) > 1;
    const bool other_axis = std::string_view("BEUVWO").find(word.letter) != std::string_view::npos;
    if (again || other_axis || (word.letter == 'G' && !plain_g(word.value, moved)) ||
        (word.letter == 'M' && calls(word.value))) {
      return &word;
    }
  }
  return nullptr;
}

}  // namespace

Error error_at(const ProgramLine& line, std::size_t offset, std::string_view what) {
  return {ErrorCode::bad_file, fmt::format("{}:{}:{}: {}", line.program, line.number, offset + 1, what)};
}

Result<std::vector<Word>> words_of(const ProgramLine& line) {
  return WordReader(line).run();
}

Result<void> check_plain(const ProgramLine& line, const std::vector<Word>& words, bool moved) {
  if (const Word* word = foreign(words, moved)) {
    return error_at(line, word->begin,
                    fmt::format("{}: only straight moves of X, Y, Z, A and C in absolute mm and degrees are read (G90, "
                                "G21), each axis once a line; have the post-processor write such",
                                line.text.substr(word->begin, word->end - word->begin)));
  }
  const auto alone = std::find_if(words.begin(), words.end(), stands_alone);
  const auto axis = std::find_if(words.begin(), words.end(),
                                 [](const Word& word) { return kAxes.find(word.letter) != std::string_view::npos; });
  if (alone != words.end() && axis != words.end()) {
    return error_at(line, axis->begin,
                    fmt::format("{} beside {}: whether it moves differs between controls; give it a line of its own",
                                line.text.substr(axis->begin, axis->end - axis->begin),
                                line.text.substr(alone->begin, alone->end - alone->begin)));
  }
  return {};
}

}  // namespace gravure::motion
