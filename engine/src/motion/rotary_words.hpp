#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::motion {

/// One word of a G-code line, in capitals; [begin, end) of the line is its text.
struct Word {
  char letter = 0;
  double value = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// A line of a program, with its name and number for errors.
struct ProgramLine {
  std::string_view program;
  std::size_t number = 0;  ///< from 1
  std::string_view text;
};

/// bad_file "program:line:column: what", the column counted from 1.
Error error_at(const ProgramLine& line, std::size_t offset, std::string_view what);

/// The words of a line outside comments (in brackets, or after a semicolon): letters with a decimal number each, blanks
/// between them. bad_file names line and column of anything else: a letter without a number, a number that goes on
/// after its end (two points, a comma, an exponent), an open comment, any other character.
Result<std::vector<Word>> words_of(const ProgramLine& line);

/// bad_file, naming line and word, unless the line is a straight, absolute move in mm of X, Y, Z, A and C, or does not
/// move them: else a reader of words alone does not know where the machine stands. Work offsets may be chosen before
/// anything has `moved` only.
Result<void> check_plain(const ProgramLine& line, const std::vector<Word>& words, bool moved);

}  // namespace gravure::motion
