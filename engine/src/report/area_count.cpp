#include "gravure/report/area_count.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "gravure/core/as_size.hpp"
#include "gravure/raster/count.hpp"

namespace gravure::report {
namespace {

/// Bits [from, to) of one byte, 0 the most significant.
int count_in_byte(std::byte byte, int from, int to) {
  const unsigned mask = (0xFFU >> static_cast<unsigned>(from)) & (0xFF00U >> static_cast<unsigned>(to));
  return std::popcount(static_cast<unsigned>(byte) & mask);
}

}  // namespace

std::int64_t cell_begin(std::int64_t index, std::int64_t cells, std::int64_t pixels) noexcept {
  return pixels / cells * index + pixels % cells * index / cells;  // index <= cells: no overflow below 2^31 cells
}

std::vector<std::int64_t> cell_sizes(std::int64_t cells, std::int64_t pixels) {
  std::vector<std::int64_t> sizes;
  sizes.reserve(as_size(cells));
  for (std::int64_t index = 0; index < cells; ++index) {
    sizes.push_back(cell_begin(index + 1, cells, pixels) - cell_begin(index, cells, pixels));
  }
  return sizes;
}

Extent choose_cells(const Extent& picture, double pixel_width, double pixel_height, std::int64_t most) {
  const double width = static_cast<double>(picture.width) * pixel_width;
  const double height = static_cast<double>(picture.height) * pixel_height;
  const auto within = [most](double wanted, std::int64_t pixels) {
    const double bounded = std::min(wanted, static_cast<double>(std::min(pixels, most)));
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(bounded));
  };
  if (picture.area() <= most) {
    return picture;
  }
  const std::int64_t columns = within(std::sqrt(static_cast<double>(most) * width / height), picture.width);
  const std::int64_t rows = within(static_cast<double>(most / columns), picture.height);
  // What a flat picture does not need of one direction goes to the other.
  return {within(static_cast<double>(most / rows), picture.width), rows};
}

std::int64_t count_between(std::span<const std::byte> row, std::int64_t from, std::int64_t to) {
  if (from >= to) {
    return 0;
  }
  const std::int64_t first = from / 8;
  const std::int64_t last = (to - 1) / 8;
  const int head = static_cast<int>(from % 8);
  const int tail = static_cast<int>(to - 8 * last);
  if (first == last) {
    return count_in_byte(row[as_size(first)], head, tail);
  }
  return count_in_byte(row[as_size(first)], head, 8) + count_in_byte(row[as_size(last)], 0, tail) +
         raster::popcount(row.subspan(as_size(first + 1), as_size(last - first - 1)));
}

AreaCount::AreaCount(const Extent& picture, const Extent& cells, CellRow counted)
    : picture_(picture), cells_(cells), counted_(std::move(counted)) {
  edges_.reserve(as_size(cells.width + 1));
  for (std::int64_t column = 0; column <= cells.width; ++column) {
    edges_.push_back(cell_begin(column, cells.width, picture.width));
  }
  ones_.assign(as_size(cells.width), 0);
}

Result<void> AreaCount::add(std::span<const std::byte> rows, std::int64_t count) {
  const std::int64_t bytes = (picture_.width + 7) / 8;
  if (count < 0 || count > picture_.height - next_row_ || rows.size() != as_size(count * bytes)) {
    return Error{ErrorCode::bad_argument, "area count: " + std::to_string(count) + " rows in " +
                                              std::to_string(rows.size()) + " bytes, " +
                                              std::to_string(picture_.height - next_row_) + " rows are left"};
  }
  for (std::int64_t i = 0; i < count; ++i) {
    const auto row = rows.subspan(as_size(i * bytes), as_size(bytes));
    for (std::size_t column = 0; column < ones_.size(); ++column) {
      ones_[column] += count_between(row, edges_[column], edges_[column + 1]);
    }
    if (++next_row_ == cell_begin(cell_row_ + 1, cells_.height, picture_.height)) {
      counted_(cell_row_++, ones_);
      std::fill(ones_.begin(), ones_.end(), 0);
    }
  }
  return {};
}

}  // namespace gravure::report
