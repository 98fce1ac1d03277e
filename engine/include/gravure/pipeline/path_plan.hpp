#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/path_motion.hpp"
#include "gravure/core/plan.hpp"

namespace gravure {

/// What a plan of a path program is made of, beside the motion itself.
struct PathPlanRequest {
  std::string title;
  Mode mode = Mode::freeform;
  LaserSettings laser;
  std::int64_t clock_multiplier = 2;  ///< j
  Rational servo_period_us = 50;
  Rational pulse_pitch_um = 0;
  PathPlan path;  ///< counts left at 0 become kPathCounts; pulses and targets are filled in by make_path_plan()
};

/// Counts of set-points a mm or rad where nothing else is asked for: fine enough that rounding changes a third
/// difference over 50 us by 3.2 mm/s^3 at most, and room for 70,000 turns of C. Of the path covered: 1 pm.
inline constexpr std::int64_t kPathCounts = 10'000'000'000'000;
inline constexpr std::int64_t kAlongCounts = 1'000'000'000;

/// The plan of a motion of `instants` instants with `pulses` pulses along it and `targets` wanted points beside it.
/// Fails with bad_argument or out_of_range: a mode without a path, a servo period that is not a whole number of pulse
/// slots (naming the nearest that are), fewer than two instants, a pitch of 0, pulses faster than the gate can be
/// switched, more ticks than 63 bits hold.
Result<Plan> make_path_plan(const PathPlanRequest& request, std::int64_t instants, std::int64_t pulses,
                            std::int64_t targets);

}  // namespace gravure
