#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "gravure/scan/line_trajectory.hpp"

namespace gravure {

/// Which terms of the scanner count.
struct ScannerTerms {
  bool galvo_resolution = false;
  bool microvectors = false;
  bool cross_scan = false;
  bool lag = false;
  /// Lines start on different fractions of a column, which U takes up: rounding its orders is left to RoundedOrders.
  bool shifted_lines = false;
  /// The stage of a flat job comes back: across is the way the lines follow each other, towards lower image lines.
  bool backwards = false;
};

struct Interval {
  double least = 0;
  double most = 0;

  double magnitude() const noexcept { return std::max(-least, most); }
  void see(double value) noexcept {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

/// Orders to U that are rounded to whole counts when the fraction of a column has been added, so that lines differ.
struct RoundedOrders {
  std::vector<double> order_um;           ///< of the set-points; where microvectors do not count, of the pulses
  std::vector<std::size_t> order_before;  ///< the last order before each pulse
  std::vector<double> share_of_next;      ///< how far on the way to the next one

  /// What rounding does to each order on a line that is moved by so much.
  std::vector<double> rounded_off_um(double shift_um, double count_um) const;
};

/// What the scanner does to the pulses of a line, in the order of time: landing minus target on the surface, for they
/// are alike for all lines of one direction; and how the beam stands, so that what lifts the surface moves the spot.
struct LineErrors {
  std::vector<double> along_um;
  std::vector<double> across_um;
  std::vector<double> defocus_um;    ///< of the surface, towards the head, where the job knows of it
  std::vector<double> slope_along;   ///< of the beam: how far it goes along the line for a um towards the head
  std::vector<double> slope_across;  ///< likewise across
  RoundedOrders rounded;             ///< empty where lines are alike
  Interval along;                    ///< of the above
  Interval across;
  Interval defocus;
  Interval slope_along_range;
  Interval slope_across_range;

  /// Nothing is known of a scanner: no error, light along the normal.
  bool is_none() const noexcept { return across_um.empty(); }
};

/// Both directions, [0] forward; [1] is as [0] where all lines run forward.
using ScannerErrors = std::array<LineErrors, 2>;

/// Terms that are off have the scanner do what the path wants. What the path itself leaves across the lines belongs to
/// cross_scan; along them, where the pulses of reverse lines are delayed, to lag.
ScannerErrors scanner_errors(const scan::LineTrajectory& trajectory, const ScannerTerms& terms);

}  // namespace gravure
