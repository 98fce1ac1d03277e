#pragma once

#include <algorithm>
#include <cmath>

#include "scanner_errors.hpp"

namespace gravure {

/// A cylinder that is not where, or not as large as, the job has it; seen from a line of its surface: outwards along
/// the normal there, onwards the way the lines follow each other.
struct ShiftedSurface {
  double radius_um = 0;    ///< as the job has it
  double growth_um = 0;    ///< of the radius, about the axis: angles on the workpiece stay what they are
  double outwards_um = 0;  ///< of the axis
  double onwards_um = 0;

  /// Where a beam meets it.
  struct Hit {
    double across_um = 0;  ///< along the surface from the line's own place, onwards
    double rise_um = 0;    ///< from where the job has the surface, along the normal of the line
  };

  /// A beam that would meet the surface of the job `from_um` onwards of the line, and moves `slope` onwards for every
  /// um it is higher: circle and line, exact. Without a number where the beam misses the cylinder.
  Hit hit(double from_um, double slope) const noexcept {
    const double p = from_um - onwards_um;
    const double q = radius_um - outwards_um;
    const double a = 1 + slope * slope;
    const double b = slope * p + q;
    const double c = p * p - (outwards_um + growth_um) * (2 * radius_um + growth_um - outwards_um);
    const double rise = -c / (b + std::sqrt(b * b - a * c));  // without cancellation, the crossing towards the head
    return {(radius_um + growth_um) * std::atan2(p + slope * rise, q + rise), rise};
  }

  struct Range {
    Interval across_um;
    Interval rise_um;
  };
  /// Of all beams that start and lean within these: along the surface the place grows with `from`, and with `slope`
  /// it moves one way (the beam turns about its own place), so the corners hold it; the rise is highest where the
  /// surface turns to the beam's own side.
  Range range(const Interval& from, const Interval& slope) const noexcept {
    const Hit first = hit(from.least, slope.least);
    Range range{{first.across_um, first.across_um}, {first.rise_um, first.rise_um}};
    for (const Hit& corner : {hit(from.least, slope.most), hit(from.most, slope.least), hit(from.most, slope.most)}) {
      range.across_um.see(corner.across_um);
      range.rise_um.see(corner.rise_um);
    }
    if (range.across_um.least < 0 && range.across_um.most > 0) {
      range.rise_um.see(outwards_um + growth_um);
    }
    return range;
  }
};

}  // namespace gravure
