#include "csv_rows.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

namespace gravure::motion {
namespace {

constexpr std::size_t kMaxRows = 10'000'000;

bool is_separator(char c) noexcept {
  return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r';
}

/// The next number of the line; false where there is none.
bool take_number(std::string_view& line, double& value) {
  while (!line.empty() && is_separator(line.front())) {
    line.remove_prefix(1);
  }
  if (!line.empty() && line.front() == '+') {
    line.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  if (error != std::errc{}) {
    return false;
  }
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  return std::isfinite(value) && (line.empty() || is_separator(line.front()));
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

}  // namespace

Result<void> read_csv_rows(std::string_view text, const CsvColumns& columns,
                           const std::function<void(std::span<const double>)>& row) {
  bool heading_allowed = true;
  std::size_t rows = 0;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (is_blank_or_comment(line)) {
      continue;
    }
    std::array<double, 3> values{};
    std::string_view rest = line;
    std::size_t taken = 0;
    while (taken < columns.count && take_number(rest, values[taken])) {
      ++taken;
    }
    if (taken == columns.count) {
      row({values.data(), taken});
      ++rows;
    } else if (!heading_allowed) {
      return Error{ErrorCode::bad_file, fmt::format("{}: line {}: \"{}\": must be {}", columns.subject, number,
                                                    line.substr(0, 60), columns.meaning)};
    }
    heading_allowed = false;
    if (rows > kMaxRows) {
      return Error{ErrorCode::bad_file,
                   fmt::format("{}: more than {} rows: shorten or thin it", columns.subject, kMaxRows)};
    }
  }
  return {};
}

}  // namespace gravure::motion
