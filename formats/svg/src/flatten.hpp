#pragma once

#include <Eigen/Core>

#include "gravure/formats/svg.hpp"

namespace gravure {

/// Turns a drawing's own coordinates (1/96 inch, y downwards) into mm, y upwards: a 2 x 3 matrix.
using SvgPlace = Eigen::Matrix<double, 2, 3>;

/// Appends chords of a curve to a stroke, which ends at its first point already; all points in own coordinates.
class Flattener {
 public:
  Flattener(const SvgPlace& place, double tolerance_mm, SvgStroke& stroke);
  void line(const Eigen::Vector2d& to);
  void cubic(const Eigen::Vector2d& from, const Eigen::Vector2d& one, const Eigen::Vector2d& other,
             const Eigen::Vector2d& to);
  /// An arc of SVG 1.1 F.6: radii, turn of the ellipse's axes, which of four arcs.
  struct Arc {
    Eigen::Vector2d radii;
    double turn_deg;
    bool large;
    bool sweep;
  };
  void arc(const Eigen::Vector2d& from, const Arc& arc, const Eigen::Vector2d& to);

 private:
  /// Chords for a piece of which the second derivative is at most `bend` (own units, over 0 to 1).
  int chords(double bend) const;

  const SvgPlace& place_;
  double scale_;  ///< mm a unit, at most
  double tolerance_mm_;
  SvgStroke& stroke_;
};

inline constexpr int kMostChords = 1'000'000;  ///< of one curve

}  // namespace gravure
