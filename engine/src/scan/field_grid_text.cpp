#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>

#include "gravure/core/byte_order_mark.hpp"
#include "gravure/scan/field_grid.hpp"

namespace gravure::scan {
namespace {

constexpr std::string_view kFirstLine = "gravure-field-grid 1";

bool is_blank(char c) noexcept {
  return c == ' ' || c == '\t' || c == '\r';
}

/// The lines that say something, with their numbers; comments start with #.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  /// False at the end of the text.
  bool next() {
    while (!text_.empty()) {
      const std::size_t end = text_.find('\n');
      line_ = text_.substr(0, end);
      text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
      ++number_;
      line_ = line_.substr(0, line_.find('#'));
      trim();
      if (!line_.empty()) {
        return true;
      }
    }
    ++number_;
    return false;
  }
  std::string_view line() const noexcept { return line_; }
  std::size_t number() const noexcept { return number_; }

  /// The next word of the line; empty at its end.
  std::string_view word() {
    const auto end = static_cast<std::size_t>(std::find_if(line_.begin(), line_.end(), is_blank) - line_.begin());
    const std::string_view found = line_.substr(0, end);
    line_.remove_prefix(end);
    trim();
    return found;
  }

 private:
  void trim() {
    while (!line_.empty() && is_blank(line_.front())) {
      line_.remove_prefix(1);
    }
    while (!line_.empty() && is_blank(line_.back())) {
      line_.remove_suffix(1);
    }
  }

  std::string_view text_;
  std::string_view line_;
  std::size_t number_ = 0;
};

class Reader {
 public:
  Reader(std::string_view text, std::string path) : lines_(without_byte_order_mark(text)), path_(std::move(path)) {}

  Result<FieldGrid> read() {
    if (!lines_.next() || lines_.line() != kFirstLine) {
      return wrong(fmt::format("must begin with \"{}\"", kFirstLine));
    }
    FieldGrid grid;
    double columns = 0;
    double rows = 0;
    GRAVURE_CHECK(read_line("columns", {&columns}, "the number of nodes along U"));
    GRAVURE_CHECK(read_line("rows", {&rows}, "the number of nodes along V"));
    const auto most = static_cast<double>(kMostGridNodes);
    for (const double count : {columns, rows}) {
      if (!(count >= 2 && count <= most) || count != std::floor(count)) {
        return wrong(fmt::format("{} nodes: must be an integer, 2 to {}", count, kMostGridNodes));
      }
    }
    grid.columns = static_cast<std::size_t>(columns);
    grid.rows = static_cast<std::size_t>(rows);
    GRAVURE_CHECK(read_line("u_mm", {&grid.u_first_mm, &grid.u_last_mm}, "U of the first and the last column"));
    GRAVURE_CHECK(read_line("v_mm", {&grid.v_first_mm, &grid.v_last_mm}, "V of the first and the last row"));
    for (std::size_t i = 0; i < grid.columns * grid.rows; ++i) {
      GridPoint error;
      GRAVURE_CHECK(read_line("", {&error.u_mm, &error.v_mm}, "the errors du_mm and dv_mm of a node"));
      grid.errors.push_back(error);
    }
    if (lines_.next()) {
      return wrong(fmt::format("more than {} x {} nodes", grid.columns, grid.rows));
    }
    if (const auto checked = check_field_grid(grid); !checked) {
      return Error{checked.error().code, path_ + ": " + checked.error().message};
    }
    return grid;
  }

 private:
  Error wrong(const std::string& text) const {
    return {ErrorCode::bad_file, fmt::format("{}:{}: field grid: {}", path_, lines_.number(), text)};
  }

  /// A line of a keyword (none where empty) and numbers.
  Result<void> read_line(std::string_view keyword, std::initializer_list<double*> numbers, std::string_view meaning) {
    const std::string expected =
        fmt::format("a line{}{} with {} is wanted", keyword.empty() ? "" : " ", keyword, meaning);
    if (!lines_.next() || (!keyword.empty() && lines_.word() != keyword)) {
      return wrong(expected);
    }
    for (double* const number : numbers) {
      const std::string_view word = lines_.word();
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *number);
      if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(*number)) {
        return wrong(expected);
      }
    }
    return lines_.line().empty() ? Result<void>() : Result<void>(wrong(expected));
  }

  Lines lines_;
  std::string path_;
};

}  // namespace

Result<FieldGrid> parse_field_grid(std::string_view text, const std::string& path) {
  if (text.size() > kMostGridBytes) {
    return Error{ErrorCode::bad_file,
                 fmt::format("{}: {} bytes: a field grid has at most {}", path, text.size(), kMostGridBytes)};
  }
  return Reader(text, path).read();
}

std::string field_grid_text(const FieldGrid& grid) {
  std::string text = fmt::format(
      "{}\ncolumns {}\nrows {}\nu_mm {} {}\nv_mm {} {}\n# du_mm dv_mm: landing minus order, row by row\n", kFirstLine,
      grid.columns, grid.rows, grid.u_first_mm, grid.u_last_mm, grid.v_first_mm, grid.v_last_mm);
  for (const GridPoint& error : grid.errors) {
    fmt::format_to(std::back_inserter(text), "{} {}\n", error.u_mm, error.v_mm);
  }
  return text;
}

}  // namespace gravure::scan
