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

/// The words of a line outside comments (in brackets, or after a semicolon) that have a number. bad_file names line
/// `number` where X, Y, Z, A or C has none, or one that is not finite.
Result<std::vector<Word>> words_of(std::string_view line, std::size_t number);

/// bad_file, naming the line and the word, unless the line is a straight, absolute move in mm of X, Y, Z, A and C, or
/// does not move them: else a reader of words alone does not know where the machine stands. Work offsets may be chosen
/// before anything has `moved` only.
Result<void> check_plain(std::string_view line, std::size_t number, const std::vector<Word>& words, bool moved);

}  // namespace gravure::motion
