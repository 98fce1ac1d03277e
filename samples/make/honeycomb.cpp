#include "honeycomb.hpp"

#include <algorithm>
#include <cmath>

namespace gravure::samples {
namespace {

// Only + - * / and sqrt below, so that every machine draws the same picture.
constexpr double kPixelUm = 8.0;
constexpr double kSideUm = 550.0;
constexpr double kRowPitchUm = 1.5 * kSideUm;
constexpr double kCellPitchUm = static_cast<double>(Honeycomb::kLinesPerCell) * kPixelUm;
constexpr double kHalfWallUm = 20.0;
constexpr double kFlankUm = 60.0;  // length over which a flank goes to full depth
constexpr double kMiddleDepth = 0.7;
constexpr double kTilt = 0.25 / kSideUm;  // depth gained a um

struct Direction {
  double along;
  double around;
};
constexpr double kHalfSqrt3 = 0.86602540378443864676;
constexpr Direction kTiltDirections[] = {{1, 0},  {0.5, kHalfSqrt3},   {-0.5, kHalfSqrt3},
                                         {-1, 0}, {-0.5, -kHalfSqrt3}, {0.5, -kHalfSqrt3}};

/// Scatters the tilt directions without a pattern (a 32-bit integer mixer).
std::uint32_t mix(std::uint32_t value) {
  value = (value ^ value >> 16) * 0x7feb352dU;
  value = (value ^ value >> 15) * 0x846ca68bU;
  return value ^ value >> 16;
}

double centre_around(std::int64_t cell_row, std::int64_t cell_column) {
  return (static_cast<double>(cell_column) + ((cell_row & 1) != 0 ? 0.5 : 0.0)) * kCellPitchUm;
}

}  // namespace

Honeycomb::Place Honeycomb::find_place(std::int64_t x, std::int64_t y) {
  const double along = (static_cast<double>(x) + 0.5) * kPixelUm;
  const double around = (static_cast<double>(y) + 0.5) * kPixelUm;
  struct Cell {
    double distance2 = 1e30;
    double along = 0;
    double around = 0;
    std::int64_t row = 0;
    std::int64_t column = 0;
  };
  Cell near[12];
  std::size_t count = 0;
  const auto row0 = static_cast<std::int64_t>(std::floor(along / kRowPitchUm));
  const auto column0 = static_cast<std::int64_t>(std::floor(around / kCellPitchUm));
  for (std::int64_t row = row0 - 1; row <= row0 + 2; ++row) {
    for (std::int64_t column = column0 - 1; column <= column0 + 1; ++column) {
      const double da = along - static_cast<double>(row) * kRowPitchUm;
      const double dr = around - centre_around(row, column);
      near[count++] = {da * da + dr * dr, da, dr, row, column};
    }
  }
  const Cell& own =
      *std::min_element(near, near + count, [](const Cell& a, const Cell& b) { return a.distance2 < b.distance2; });
  double border = 1e30;
  for (const Cell& other : near) {
    const double apart2 = (own.along - other.along) * (own.along - other.along) +
                          (own.around - other.around) * (own.around - other.around);
    if (apart2 > 0) {
      border = std::min(border, (other.distance2 - own.distance2) / (2 * std::sqrt(apart2)));
    }
  }
  return {static_cast<float>(border), static_cast<float>(own.along), static_cast<float>(own.around),
          static_cast<std::int16_t>(own.row), static_cast<std::int16_t>(own.column)};
}

Honeycomb::Honeycomb() : places_(static_cast<std::size_t>(kWidth * kLinesPerCell)) {
  for (std::int64_t y = 0; y < kLinesPerCell; ++y) {
    for (std::int64_t x = 0; x < kWidth; ++x) {
      places_[static_cast<std::size_t>(y * kWidth + x)] = find_place(x, y);
    }
  }
}

void Honeycomb::row(std::int64_t y, std::vector<std::uint16_t>& levels) const {
  const std::int64_t column0 = y / kLinesPerCell;
  const Place* place = &places_[static_cast<std::size_t>(y % kLinesPerCell * kWidth)];
  for (std::int64_t x = 0; x < kWidth; ++x, ++place) {
    const std::int64_t column = (column0 + place->cell_column + kCellsRound) % kCellsRound;
    const auto cell = static_cast<std::uint32_t>((place->cell_row + 1) * kCellsRound + column);
    const Direction& tilt = kTiltDirections[mix(cell) % 6];
    const double floor = kMiddleDepth + kTilt * (tilt.along * static_cast<double>(place->along_um) +
                                                 tilt.around * static_cast<double>(place->around_um));
    const double flank = (static_cast<double>(place->border_um) - kHalfWallUm) / kFlankUm;
    const double depth = std::clamp(std::min(floor, flank), 0.0, 1.0);
    const auto level = static_cast<std::uint16_t>(std::lround(depth * 65535.0));
    levels[static_cast<std::size_t>(x)] = x < kWidth / 2 ? level : static_cast<std::uint16_t>(65535 - level);
  }
}

}  // namespace gravure::samples
