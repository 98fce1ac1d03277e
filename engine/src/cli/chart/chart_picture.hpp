#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/formats/tiff_writer.hpp"

namespace gravure::cli {

/// Pixels that fire, of one colour: `width` columns from `x`, on `height` rows from `y`, or on every `step`-th of them.
/// Rows count on round the circumference: row -1 is the last one.
struct ChartBox {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t width = 1;
  std::int64_t height = 1;
  std::int64_t step = 1;
};

/// A picture of boxes and numbers, white on black, drawn row by row: it may be larger than memory.
class ChartPicture {
 public:
  ChartPicture(std::int64_t width, std::int64_t height) : width_(width), height_(height) {}
  void fill(const ChartBox& box) { boxes_.push_back(box); }
  /// Digits and signs, 3 x 5 dots of `scale` pixels each, a dot apart; on every `step`-th row.
  void write(std::int64_t x, std::int64_t y, const std::string& text, std::int64_t scale, std::int64_t step = 1);
  static std::int64_t text_width(const std::string& text, std::int64_t scale);

  BilevelTiffPage page() const;
  Result<void> append_to(BilevelTiffWriter& writer) const;

 private:
  void draw(std::int64_t row, std::vector<std::byte>& bits) const;
  std::int64_t width_;
  std::int64_t height_;
  std::vector<ChartBox> boxes_;
};

}  // namespace gravure::cli
