#pragma once

#include <cstdint>
#include <vector>

namespace gravure::samples {

/// A 3-D honeycomb for an embossing roller of 35 mm radius and 28 mm face, at 8 um both ways.
///
/// Hexagons of 550 um side stand with a corner along the axis. Nominally they are sqrt(3) * 550 = 952.63 um wide round
/// the roller; 231 of them, the nearest whole number, take 952.00 um or exactly 119 lines each, so that the picture
/// closes without a seam. Every cell has flat walls 40 um wide, flanks, and a floor tilted in one of six directions.
/// The left half is engraved so, the right half is its inverse.
class Honeycomb {
 public:
  static constexpr std::int64_t kWidth = 3500;    ///< pixels along the axis
  static constexpr std::int64_t kHeight = 27489;  ///< lines round the circumference
  static constexpr std::int64_t kCellsRound = 231;
  static constexpr std::int64_t kLinesPerCell = kHeight / kCellsRound;
  static_assert(kLinesPerCell * kCellsRound == kHeight);

  Honeycomb();
  /// Depth of row `y`: 0 untouched, 65535 deepest.
  void row(std::int64_t y, std::vector<std::uint16_t>& levels) const;

 private:
  /// Where a pixel of the first kLinesPerCell lines lies; the others repeat them.
  struct Place {
    float border_um = 0;        ///< to the border of its cell
    float along_um = 0;         ///< from the centre of its cell, along the axis
    float around_um = 0;        ///< the same, round the roller
    std::int16_t cell_row = 0;  ///< which cell
    std::int16_t cell_column = 0;
  };
  static Place find_place(std::int64_t x, std::int64_t y);
  std::vector<Place> places_;
};

}  // namespace gravure::samples
