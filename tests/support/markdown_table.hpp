#pragma once

#include <string>
#include <vector>

namespace gravure::test {

/// `text` without spaces at its ends.
inline std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// The cells of "| a | b |", without back-quotes: for tests that hold a page of the docs against the code.
inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::string cell;
  for (const char c : line.substr(1)) {
    if (c == '|') {
      cells.push_back(trimmed(cell));
      cell.clear();
    } else if (c != '`') {
      cell += c;
    }
  }
  return cells;
}

}  // namespace gravure::test
