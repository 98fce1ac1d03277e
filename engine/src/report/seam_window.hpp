#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gravure/report/layer_pictures.hpp"

namespace gravure::report {

/// Keeps the pixels about the seam of a bilevel picture as its rows come, joined: what lies before the seam first.
class SeamWindow {
 public:
  SeamWindow(const Extent& picture, const SeamPlace& place, bool lines_are_rows)
      : picture_(picture), place_(place), lines_are_rows_(lines_are_rows) {
    ones_.resize(static_cast<std::size_t>(2 * place.lines_each * place.columns));
  }
  /// The next rows, packed MSB first.
  void add(std::span<const std::byte> rows, std::int64_t count) {
    const std::size_t bytes = static_cast<std::size_t>((picture_.width + 7) / 8);
    for (std::int64_t i = 0; i < count; ++i, ++next_row_) {
      keep(rows.subspan(static_cast<std::size_t>(i) * bytes, bytes));
    }
  }
  const std::vector<bool>& ones() const noexcept { return ones_; }

 private:
  static constexpr std::int64_t kElsewhere = -1;
  /// Where line `line` of `lines` lies among those that are kept.
  std::int64_t line_place(std::int64_t line, std::int64_t lines) const {
    if (line < place_.lines_each) {
      return place_.lines_each + line;
    }
    const std::int64_t from_end = lines - 1 - line;
    return from_end < place_.lines_each ? place_.lines_each - 1 - from_end : kElsewhere;
  }
  static bool bit(std::span<const std::byte> row, std::int64_t x) {
    return ((static_cast<unsigned>(row[static_cast<std::size_t>(x / 8)]) >> (7 - x % 8)) & 1U) != 0;
  }
  void keep(std::span<const std::byte> row) {
    if (lines_are_rows_) {
      const std::int64_t place = line_place(next_row_, picture_.height);
      for (std::int64_t x = 0; place != kElsewhere && x < place_.columns; ++x) {
        ones_[static_cast<std::size_t>(place * place_.columns + x)] = bit(row, place_.first_column + x);
      }
      return;
    }
    const std::int64_t y = next_row_ - place_.first_column;
    if (y < 0 || y >= place_.columns) {
      return;
    }
    const std::int64_t width = 2 * place_.lines_each;
    for (std::int64_t k = 0; k < width; ++k) {
      const std::int64_t line = k < place_.lines_each ? picture_.width - place_.lines_each + k : k - place_.lines_each;
      ones_[static_cast<std::size_t>(y * width + k)] = bit(row, line);
    }
  }

  Extent picture_;
  SeamPlace place_;
  bool lines_are_rows_;
  std::int64_t next_row_ = 0;
  std::vector<bool> ones_;
};

}  // namespace gravure::report
