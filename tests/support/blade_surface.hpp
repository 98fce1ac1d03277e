#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "dice.hpp"
#include "gravure/core/point_set.hpp"

namespace gravure::test {

/// A turbine blade with a platform in closed form, for registration: thickness, camber, twist and lean, about 60 mm of
/// chord and 150 mm of span along z, normals exact.
class BladeSurface {
 public:
  static constexpr double kSpanMm = 150;
  static constexpr double kHalfChordMm = 30;

  struct Sample {
    Point3 point;
    Point3 normal;
  };

  /// The profile at `angle` (0 .. 2 pi, from trailing edge over suction side) and height `z`.
  static Sample on_blade(double angle, double z) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double shrink = 1 - 0.2 * z / kSpanMm;
    const double x = kHalfChordMm * c;
    const double y = 6 * s * s + (2.5 - 1.2 * c) * s;
    const std::array<double, 2> along{-kHalfChordMm * s, 12 * s * c + 2.5 * c - 1.2 * (c * c - s * s)};
    const double twist = 0.7 * z / kSpanMm;
    const double turn = 0.7 / kSpanMm;
    const double ct = std::cos(twist);
    const double st = std::sin(twist);
    const auto turned = [&](double u, double v) { return std::array<double, 2>{ct * u - st * v, st * u + ct * v}; };
    const auto place = turned(x, y);
    const auto slope = turned(along[0], along[1]);
    const double lean = 0.05 * kSpanMm * std::pow(z / kSpanMm, 2);
    // d/dz of shrink * rotation(twist) * (x, y) + (0, lean)
    const double dx = -0.2 / kSpanMm * place[0] - shrink * turn * place[1];
    const double dy = -0.2 / kSpanMm * place[1] + shrink * turn * place[0] + 0.1 * z / kSpanMm;
    const double px = shrink * slope[0];
    const double py = shrink * slope[1];
    // (px, py, 0) x (dx, dy, 1)
    const double length = std::sqrt(py * py + px * px + std::pow(px * dy - py * dx, 2));
    return {{shrink * place[0], shrink * place[1] + lean, z},
            {py / length, -px / length, (px * dy - py * dx) / length}};
  }

  /// Anywhere: four fifths on the blade, the rest on the upper face and two sides of the platform below it.
  static Sample anywhere(Dice& dice) {
    const double kind = unit(dice);
    const double u = unit(dice);
    const double v = unit(dice);
    if (kind < 0.8) {
      return on_blade(2 * std::numbers::pi * u, kSpanMm * v);
    }
    if (kind < 0.92) {
      return {{-40 + 80 * u, (v < 0.5 ? -25 + 20 * v : 7 + 20 * v), 0}, {0, 0, 1}};
    }
    if (kind < 0.96) {
      return {{40, -25 + 52 * u, -10 * v}, {1, 0, 0}};
    }
    return {{-40 + 80 * u, -25, -10 * v}, {0, -1, 0}};
  }

  static double unit(Dice& dice) { return static_cast<double>(dice.word() >> 11U) * 0x1p-53; }

  /// Of mean 0 and deviation 1 (Box and Muller).
  static double normal(Dice& dice) {
    return std::sqrt(-2 * std::log(1 - unit(dice))) * std::cos(2 * std::numbers::pi * unit(dice));
  }

  static PointSet points(std::size_t count, Dice& dice) {
    PointSet set;
    for (std::size_t i = 0; i < count; ++i) {
      const Sample sample = anywhere(dice);
      set.points_mm.push_back(sample.point);
      set.normals.push_back(sample.normal);
    }
    return set;
  }
};

}  // namespace gravure::test
