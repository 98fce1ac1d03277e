#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "gravure/core/csv_rows.hpp"
#include "point_text.hpp"
#include "readers.hpp"

namespace gravure {
namespace {

/// Numbers in the first line that starts with one: 3, or 6 with normals.
std::size_t columns_of(std::string_view text) {
  while (!text.empty()) {
    std::string line(take_line(text));
    line.resize(std::min(line.size(), line.find('#')));
    for (char& c : line) {
      c = c == ',' || c == ';' ? ' ' : c;
    }
    TextWords words(line);
    std::size_t count = 0;
    double value = 0;
    for (std::string_view word = words.next(); to_number(word, value); word = words.next()) {
      ++count;
    }
    if (count > 0) {
      return count;
    }
  }
  return 3;
}

}  // namespace

Result<PointFile> parse_point_text(std::string_view bytes, const std::string& name) {
  const bool has_normals = columns_of(without_byte_order_mark(bytes)) == 6;
  PointFile file;
  const auto add = [&file, has_normals](std::span<const double> row) {
    file.points.points_mm.push_back({row[0], row[1], row[2]});
    if (has_normals) {
      file.points.normals.push_back({row[3], row[4], row[5]});
    }
  };
  const auto add_finite = [&file, &add](std::size_t line, std::span<const double> row) {
    if (std::all_of(row.begin(), row.begin() + 3, [](double value) { return std::isfinite(value); })) {
      add(row);  // a normal alone is missing
    } else {
      file.add_dropped("line " + std::to_string(line));
    }
  };
  const CsvColumns columns{name,
                           has_normals ? "x y z in mm and a normal nx ny nz as in the lines before, six numbers"
                                       : "x y z in mm, or x y z nx ny nz: three or six numbers, in every line as many",
                           has_normals ? std::size_t{6} : std::size_t{3},
                           {},
                           add_finite};
  GRAVURE_CHECK(read_csv_rows(bytes, columns, add));
  return file;
}

}  // namespace gravure
