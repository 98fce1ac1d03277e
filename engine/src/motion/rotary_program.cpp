#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gravure/motion/unreverse.hpp"
#include "rotary_words.hpp"

namespace gravure::motion {
namespace {

constexpr std::size_t kMaxBlocks = 10'000'000;

struct Position {
  std::array<double, 3> xyz{};
  double a = 0;
  double c = 0;

  double* word(char letter) noexcept {
    switch (letter) {
      case 'X':
        return &xyz[0];
      case 'Y':
        return &xyz[1];
      case 'Z':
        return &xyz[2];
      case 'A':
        return &a;
      case 'C':
        return &c;
      default:
        return nullptr;
    }
  }
};

/// LinuxCNC's codes that choose between the tip and the machine's axes.
bool switches_frame(const std::vector<Word>& words) noexcept {
  return std::any_of(words.begin(), words.end(),
                     [](const Word& word) { return word.letter == 'M' && word.value >= 428 && word.value <= 430; });
}

struct Moved {
  bool rotary = false;  ///< A or C
  bool linear = false;  ///< X, Y or Z
};

/// Takes the words of one line.
Moved take_line(const std::vector<Word>& words, Position& modal) noexcept {
  Moved moved;
  for (const Word& word : words) {
    if (double* axis = modal.word(word.letter)) {
      *axis = word.value;
      const bool rotary = word.letter == 'A' || word.letter == 'C';
      (rotary ? moved.rotary : moved.linear) = true;
    }
  }
  return moved;
}

}  // namespace

Result<RotaryPath> parse_rotary_program(std::string_view text, std::string_view name) {
  RotaryPath path;
  Position modal;
  bool any_move = false;
  std::size_t switched_line = 0;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const ProgramLine line{name, number, text.substr(0, end)};
    GRAVURE_TRY(const auto words, words_of(line));
    GRAVURE_CHECK(check_plain(line, words, any_move));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    const Moved moved = take_line(words, modal);
    if (switched_line > 0 && (moved.rotary || moved.linear)) {
      return error_at(line, 0,
                      fmt::format("moves in another frame than the moves before line {}, which switches it; split the "
                                  "program there",
                                  switched_line));
    }
    any_move = any_move || moved.rotary || moved.linear;
    switched_line = any_move && switches_frame(words) ? number : switched_line;
    if (moved.rotary) {
      path.a_deg.push_back(modal.a);
      path.c_deg.push_back(modal.c);
      path.line.push_back(number);
      path.xyz_mm.push_back(modal.xyz);
    } else if (moved.linear && !path.line.empty()) {
      path.linear.push_back({path.line.size() - 1, number, modal.xyz});
    }
    if (path.line.size() + path.linear.size() > kMaxBlocks) {
      return Error{ErrorCode::bad_file, fmt::format("{}: more than {} blocks: split it", name, kMaxBlocks)};
    }
  }
  return path;
}

}  // namespace gravure::motion
