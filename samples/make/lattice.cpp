#include "lattice.hpp"

#include <algorithm>

namespace gravure::samples {
namespace {

constexpr std::int64_t kHalfStrut = 8;  // pixels
constexpr std::int64_t kRing = 10;
// Struts run where x / 250 +- y / 157 is whole. Times 2 * 250 * 157 that is an integer at every pixel centre, and its
// distance from the next strut times 2 * hypot(250, 157) is that integer's distance from a multiple of kWhole.
constexpr std::int64_t kWhole = 2 * DiamondLattice::kCellPixels * DiamondLattice::kCellLines;
constexpr std::int64_t kLength2 =
    DiamondLattice::kCellPixels * DiamondLattice::kCellPixels + DiamondLattice::kCellLines * DiamondLattice::kCellLines;

bool on_strut(std::int64_t position) {
  const std::int64_t rest = (position % kWhole + kWhole) % kWhole;
  const std::int64_t away = std::min(rest, kWhole - rest);
  return away * away <= 4 * kHalfStrut * kHalfStrut * kLength2;
}

}  // namespace

void DiamondLattice::row(std::int64_t y, std::vector<std::uint16_t>& levels) {
  for (std::int64_t x = 0; x < kWidth; ++x) {
    const std::int64_t along = kCellLines * (2 * x + 1);
    const std::int64_t around = kCellPixels * (2 * y + 1);
    const bool strut = x < kRing || x >= kWidth - kRing || on_strut(along + around) || on_strut(along - around);
    levels[static_cast<std::size_t>(x)] = strut ? 0 : 65535;
  }
}

}  // namespace gravure::samples
