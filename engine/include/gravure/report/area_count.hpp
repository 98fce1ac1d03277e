#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::report {

/// A size in pixels or cells.
struct Extent {
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::int64_t area() const noexcept { return width * height; }
};

/// Where cell `index` of `cells` begins among `pixels`: floor(index * pixels / cells). Cells cover every pixel once.
std::int64_t cell_begin(std::int64_t index, std::int64_t cells, std::int64_t pixels) noexcept;
/// The pixels of each of `cells` cells.
std::vector<std::int64_t> cell_sizes(std::int64_t cells, std::int64_t pixels);

/// How many cells a picture is shown in: at most `most`, about square on the workpiece where a pixel is `pixel_width`
/// by `pixel_height` of any unit, and never more than its pixels.
Extent choose_cells(const Extent& picture, double pixel_width, double pixel_height, std::int64_t most);

/// Counts the ones of a bilevel picture cell by cell, exactly, as its rows come: the average over the area of a cell is
/// its count over its pixels. Takes the memory of a row of cells, whatever the picture.
class AreaCount {
 public:
  /// Takes a row of cells that is counted: its number from the top, and the ones of each of its cells.
  using CellRow = std::function<void(std::int64_t row, std::span<const std::int64_t> ones)>;

  /// 1 <= cells <= picture, in both directions.
  AreaCount(const Extent& picture, const Extent& cells, CellRow counted);
  /// The next `count` rows, packed MSB first. Fails with bad_argument beyond the picture.
  Result<void> add(std::span<const std::byte> rows, std::int64_t count);

  bool complete() const noexcept { return next_row_ == picture_.height; }

 private:
  Extent picture_;
  Extent cells_;
  std::vector<std::int64_t> edges_;  ///< first pixel of each column of cells, and the width
  CellRow counted_;
  std::vector<std::int64_t> ones_;  ///< of the cells of cell_row_
  std::int64_t next_row_ = 0;
  std::int64_t cell_row_ = 0;
};

/// Ones of bits [from, to) of a row packed MSB first.
std::int64_t count_between(std::span<const std::byte> row, std::int64_t from, std::int64_t to);

}  // namespace gravure::report
