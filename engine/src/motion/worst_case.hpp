#pragma once

#include <span>
#include <vector>

#include "gravure/motion/search.hpp"

namespace gravure::motion {

/// The longest wait over all mode errors.
struct WorstCase {
  double after_s = 0;       ///< from the end of the input
  std::vector<Mode> modes;  ///< that are still outside the band then
};

/// The last instant, after the end of the input, at which modes within +-mode_error_percent of each frequency and each
/// damping can be outside the band; frequencies and dampings err independently, shares stay. Never earlier than the
/// truth, and not later than for a band 0.1 % narrower as long as the search for it stays within its means (else it is
/// the time from which on the band is proved to hold).
///
/// The errors of different modes are independent, so the most that a signal can be at one instant is the sum of what
/// each mode can be. One mode is Im H(lambda) / wd with H analytic in lambda; that stays below c where Im(H - c lambda)
/// stays below 0, and a harmonic function has its greatest value on the border of a region: errors inside the rectangle
/// of one mode need not be looked at. On its sides the mode is interpolated by cubics through values and slopes, with
/// the bound of the fourth derivative added.
WorstCase worst_case(const SearchProblem& problem, std::span<const InputJump> input);

}  // namespace gravure::motion
