#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>

#include "gravure/core/error.hpp"

namespace gravure {

inline constexpr std::size_t kMostCsvColumns = 7;

/// What the columns of a CSV text mean, for messages.
struct CsvColumns {
  std::string_view subject;  ///< "recording"
  std::string_view meaning;  ///< "time in s and acceleration in mm/s^2, two numbers"
  std::size_t count = 2;     ///< at most kMostCsvColumns; a line with more is refused
  /// The heading that the text may have, without blanks: "u_mm,v_mm". Empty: any words.
  std::string_view heading = {};
  /// Gets a row with a number that is not finite, with its line, in place of `row`. None: such a row is refused.
  std::function<void(std::size_t line, std::span<const double>)> not_finite = nullptr;
};

/// Calls `row` with the numbers of each line, separated by comma, semicolon, tab or blanks: no cell may be empty but
/// after the last number. A first line without any number is a heading; what follows a # is a comment; a byte order
/// mark is passed over. bad_file names the line that is anything else, and more than 10 million rows.
Result<void> read_csv_rows(std::string_view text, const CsvColumns& columns,
                           const std::function<void(std::span<const double>)>& row);

}  // namespace gravure
