#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "gravure/core/contour.hpp"

namespace gravure::test {

/// A part like the ceramic core of [D]: 60 contours in three areas whose directions spread over 13.97, 15.82 and 13.03
/// degrees. The first and the last area lie 3 mm apart on both sides of a thin edge and turn against each other, up to
/// 39.8 degrees; the middle one runs 95 mm along the core.
class CeramicCore {
 public:
  static constexpr std::array<std::size_t, 3> kContours{18, 24, 18};
  static constexpr std::array<double, 3> kSpread_deg{13.97, 15.82, 13.03};

  static std::vector<Contour> contours() {
    std::vector<Contour> all;
    for (std::size_t area = 0; area < kSpread_deg.size(); ++area) {
      for (std::size_t i = 0; i < kContours[area]; ++i) {
        all.push_back(contour(area, static_cast<double>(i) / static_cast<double>(kContours[area] - 1)));
        all.back().id = static_cast<std::int64_t>(all.size());
      }
    }
    return all;
  }

 private:
  using Vector = std::array<double, 3>;

  /// The contour `along` (0 to 1) its area: a bent line of 4 mm, 0.2 mm lower at its ends.
  static Contour contour(std::size_t area, double along) {
    constexpr double kRadians = std::numbers::pi / 180;
    constexpr double kMostApart_deg = 39.8;
    const double spread = kSpread_deg[area];
    double azimuth = 0;
    double elevation = 0;
    Vector middle{};
    if (area == 1) {
      elevation = 30 + spread * (along - 0.5);
      middle = {10, 1.5, 5 + 95 * along};
    } else {
      const double side = area == 0 ? -1 : 1;
      azimuth = side * (kMostApart_deg / 2 - spread * along);
      middle = {8.5 * along, area == 0 ? 0.0 : 3.0, 5};
    }
    azimuth *= kRadians;
    elevation *= kRadians;
    Contour contour;
    contour.direction = {std::cos(elevation) * std::sin(azimuth), -std::cos(elevation) * std::cos(azimuth),
                         std::sin(elevation)};
    const Vector across{std::cos(azimuth), std::sin(azimuth), 0};
    const Vector up{-std::sin(elevation) * std::sin(azimuth), std::sin(elevation) * std::cos(azimuth),
                    std::cos(elevation)};
    constexpr int kHalf = 20;
    for (int k = -kHalf; k <= kHalf; ++k) {
      const double s = 2.0 * k / kHalf;
      const double wave = 0.3 * std::sin(std::numbers::pi * s);
      const double sag = -s * s / 20;
      Vector point{};
      for (std::size_t axis = 0; axis < point.size(); ++axis) {
        point[axis] = middle[axis] + s * across[axis] + wave * up[axis] + sag * contour.direction[axis];
      }
      contour.points_mm.push_back(point);
    }
    return contour;
  }
};

}  // namespace gravure::test
