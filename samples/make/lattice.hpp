#pragma once

#include <cstdint>
#include <vector>

namespace gravure::samples {

/// A diamond lattice for a stent of 1.8 mm diameter and 18 mm length, at 6 um both ways: struts 96 um wide stay
/// (black), what lies between is cut (white). Six diamonds of 157 lines go round exactly, twelve of 250 pixels along.
class DiamondLattice {
 public:
  static constexpr std::int64_t kWidth = 3000;  ///< pixels along the axis
  static constexpr std::int64_t kHeight = 942;  ///< lines round the circumference
  static constexpr std::int64_t kCellPixels = 250;
  static constexpr std::int64_t kCellLines = 157;
  static_assert(kWidth % kCellPixels == 0 && kHeight % kCellLines == 0);

  /// 65535 white, 0 black. The first and last ten pixels of each line are the end rings.
  static void row(std::int64_t y, std::vector<std::uint16_t>& levels);
};

}  // namespace gravure::samples
