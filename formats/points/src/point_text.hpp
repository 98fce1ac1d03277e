#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "gravure/core/byte_order_mark.hpp"  // what takes lines passes over it
#include "gravure/core/error.hpp"

namespace gravure {

/// Words between blanks and line ends, with the line they stand in.
class TextWords {
 public:
  explicit TextWords(std::string_view text, std::int64_t line = 1) : rest_(text), line_(line) {}
  /// The next word; empty at the end.
  std::string_view next();
  std::int64_t line() const noexcept { return line_; }  ///< of the last word
  std::string_view rest() const noexcept { return rest_; }
  void skip_line();

 private:
  std::string_view rest_;
  std::int64_t line_;
};

/// The next line without its end ("\n" or "\r\n"), taken off `rest`.
std::string_view take_line(std::string_view& rest);

/// False unless the whole word is a number: decimal, exponent, +, nan, inf.
bool to_number(std::string_view word, double& value);
/// False unless the whole word is an integer of 0 or more.
bool to_count(std::string_view word, std::uint64_t& value);

/// Short, in quotes, and nothing in it that a terminal would obey.
std::string in_quotes(std::string_view word);

/// "name: line 3: what"
Error bad_line(const std::string& name, std::int64_t line, const std::string& what);
Error bad_byte(const std::string& name, std::size_t byte, const std::string& what);

}  // namespace gravure
