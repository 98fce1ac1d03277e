#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "gravure/formats/nc_program.hpp"

namespace gravure::nc {

inline constexpr std::string_view kStageLetters = "XYZACW";

/// A decimal with the digits a block has: 1e-9 of its unit.
std::string number(double value);
/// Safe inside a comment: no brackets, no control characters, one line.
std::string comment(std::string_view text);

/// Lines of an NC program, each cut into words as it is read.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}
  /// The next line that is not empty and no comment; false at the end.
  bool next();
  /// Is it somewhere in what is left of the line?
  bool holds(std::string_view word) const noexcept { return line_.find(word) != std::string_view::npos; }
  bool at_end_of_line() const noexcept { return line_.empty(); }
  /// Takes `word` where the line goes on with it.
  bool take(std::string_view word);
  /// Takes a decimal number.
  std::optional<double> take_number();
  Error bad(const std::string& why) const;

 private:
  std::string_view text_;
  std::string_view line_;
  std::size_t number_ = 0;
};

}  // namespace gravure::nc
