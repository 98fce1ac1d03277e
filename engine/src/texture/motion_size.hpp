#pragma once

#include <cstdint>

#include "gravure/core/error.hpp"

namespace gravure::texture {

/// Refuses motion of at least `time_s` that has more than kMostPeriods, before anything as long as it is made.
Result<void> check_duration(double time_s, double servo_s);

/// Refuses motion described by places `apart` servo periods from each other (control points of feeds and of the stages'
/// place) where there would be too many of them, or too many periods between two.
Result<void> check_places(double time_s, double servo_s, double apart);

}  // namespace gravure::texture
