#pragma once

#include <string>
#include <vector>

#include "damped_fit.hpp"
#include "gravure/motion/identify.hpp"

namespace gravure::motion {

/// Modes closer to each other than so many of their standard deviations are not told apart.
constexpr double kApartInDeviations = 3;

/// Modes whose amplitude is not more than so many of its standard deviations do not stand out.
constexpr double kStandsOutInDeviations = 4;

/// See IdentifiedMode::resolution_hz: the distance from which on the uncertainties of the pair, at the noise of the
/// fit, pass the tests that a pair found in the data must pass; to 1 %.
double resolution_hz(const Series& series, const DampedFit& fit, std::size_t mode);

/// See Identification::warnings.
std::vector<std::string> warnings_of(const Series& series, const DampedFit& fit, const Identification& found);

}  // namespace gravure::motion
