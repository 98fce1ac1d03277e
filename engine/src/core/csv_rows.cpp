#include "gravure/core/csv_rows.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string>

#include "gravure/core/byte_order_mark.hpp"

namespace gravure {
namespace {

constexpr std::size_t kMaxRows = 10'000'000;

bool is_separator(char c) noexcept {
  return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r';
}

/// The next number of the line, finite or not; false where there is none, or an empty cell before it.
bool take_number(std::string_view& line, double& value, bool first) {
  int commas = 0;
  while (!line.empty() && is_separator(line.front())) {
    commas += line.front() == ' ' || line.front() == '\r' ? 0 : 1;
    line.remove_prefix(1);
  }
  if (commas > (first ? 0 : 1)) {
    return false;
  }
  if (!line.empty() && line.front() == '+') {
    line.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  if (error != std::errc{}) {
    return false;
  }
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  return line.empty() || is_separator(line.front());
}

/// Words alone: nothing in it that is, or was meant as, a row.
bool is_heading(std::string_view line, std::string_view wanted) {
  std::string plain;
  while (!line.empty()) {
    const std::size_t end = line.find_first_of(",;\t");
    std::string_view cell = line.substr(0, end);
    double value = 0;
    if (take_number(cell, value, true)) {
      return false;
    }
    std::copy_if(cell.begin(), cell.end(), std::back_inserter(plain), [](char c) { return !is_separator(c); });
    if (end != std::string_view::npos) {
      plain += ',';
    }
    line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
  }
  return wanted.empty() || plain == wanted;
}

bool is_blank_or_comment(std::string_view line) noexcept {
  for (const char c : line) {
    if (c == '#') {
      return true;
    }
    if (!is_separator(c)) {
      return false;
    }
  }
  return true;
}

/// The line as a message may show it: short, and nothing that a terminal would obey.
std::string shown(std::string_view line) {
  std::string text(line.substr(0, 60));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; }, '?');
  return text;
}

}  // namespace

Result<void> read_csv_rows(std::string_view text, const CsvColumns& columns,
                           const std::function<void(std::span<const double>)>& row) {
  assert(columns.count <= kMostCsvColumns);
  text = without_byte_order_mark(text);
  bool heading_allowed = true;
  std::size_t rows = 0;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (is_blank_or_comment(line)) {
      continue;
    }
    std::array<double, kMostCsvColumns> values{};
    std::string_view rest = line;
    std::size_t taken = 0;
    while (taken < columns.count && take_number(rest, values[taken], taken == 0)) {
      ++taken;
    }
    const bool is_finite = std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
    if (taken == columns.count && is_blank_or_comment(rest) && (is_finite || columns.not_finite)) {
      const std::span<const double> numbers(values.data(), taken);
      is_finite ? row(numbers) : columns.not_finite(number, numbers);
      ++rows;
    } else if (!heading_allowed || !is_heading(line, columns.heading)) {
      const std::string heading =
          heading_allowed && !columns.heading.empty() ? ", or the heading " + std::string(columns.heading) : "";
      return Error{ErrorCode::bad_file, std::string(columns.subject) + ": line " + std::to_string(number) + ": \"" +
                                            shown(line) + "\": must be " + std::string(columns.meaning) + heading};
    }
    heading_allowed = false;
    if (rows > kMaxRows) {
      return Error{ErrorCode::bad_file, std::string(columns.subject) + ": more than " + std::to_string(kMaxRows) +
                                            " rows: shorten or thin it"};
    }
  }
  return {};
}

}  // namespace gravure
