#include <fmt/format.h>

#include <array>

#include "gravure/motion/unreverse.hpp"
#include "rotary_words.hpp"

namespace gravure::motion {
namespace {

constexpr std::size_t kMaxBlocks = 10'000'000;

struct Modal {
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

/// Takes the words of one line; true where A or C moved.
bool take_line(const std::vector<Word>& words, Modal& modal) noexcept {
  bool rotary = false;
  for (const Word& word : words) {
    if (double* axis = modal.word(word.letter)) {
      *axis = word.value;
      rotary = rotary || word.letter == 'A' || word.letter == 'C';
    }
  }
  return rotary;
}

}  // namespace

Result<RotaryPath> parse_rotary_program(std::string_view text) {
  RotaryPath path;
  Modal modal;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    GRAVURE_TRY(const auto words, words_of(text.substr(0, end), number));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (take_line(words, modal)) {
      path.a_deg.push_back(modal.a);
      path.c_deg.push_back(modal.c);
      path.line.push_back(number);
      path.xyz_mm.push_back(modal.xyz);
    }
    if (path.line.size() > kMaxBlocks) {
      return Error{ErrorCode::bad_file, fmt::format("rotary program: more than {} blocks", kMaxBlocks)};
    }
  }
  return path;
}

}  // namespace gravure::motion
