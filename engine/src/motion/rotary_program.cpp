#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "gravure/motion/unreverse.hpp"

namespace gravure::motion {
namespace {

constexpr std::size_t kMaxBlocks = 10'000'000;

/// The line without comments and blanks, in capitals.
std::string plain_line(std::string_view line) {
  std::string plain;
  bool comment = false;
  for (const char c : line) {
    comment = comment || c == '(';
    if (c == ';' && !comment) {
      break;
    }
    if (!comment && c != ' ' && c != '\t' && c != '\r') {
      plain += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    comment = comment && c != ')';
  }
  return plain;
}

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

Error bad_word(std::size_t line, char letter) {
  return Error{ErrorCode::bad_file, fmt::format("rotary program: line {}: word {} has no finite number", line, letter)};
}

/// Reads the words of one line; true where A or C moved.
Result<bool> take_line(const std::string& line, std::size_t number, Modal& modal) {
  bool rotary = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    double* word = modal.word(line[i]);
    if (word == nullptr) {
      continue;
    }
    const char letter = line[i];
    i += i + 1 < line.size() && line[i + 1] == '+' ? 1 : 0;
    double value = 0;
    const auto [end, error] = std::from_chars(line.data() + i + 1, line.data() + line.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) {
      return bad_word(number, letter);
    }
    *word = value;
    rotary = rotary || letter == 'A' || letter == 'C';
    i = static_cast<std::size_t>(end - line.data()) - 1;
  }
  return rotary;
}

}  // namespace

Result<RotaryPath> parse_rotary_program(std::string_view text) {
  RotaryPath path;
  Modal modal;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string line = plain_line(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    GRAVURE_TRY(const bool rotary, take_line(line, number, modal));
    if (rotary) {
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
