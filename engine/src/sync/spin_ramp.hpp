#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"

namespace gravure::sync_plan {

/// Where an axis comes to rest after a run of the board. In every place the counter has gone whole A-B periods, so that
/// the next run, before which the board keeps it, begins at 0 as it is counted.
enum class Rest : std::uint8_t {
  next_period,  ///< the first A-B period there is: no run follows
  turn_back,    ///< a pass: where the spin-up of the next one, which goes back, begins
  whole_turns,  ///< of the workpiece, from where it was at rest before: the next band begins like this one
};

/// An axis that is to be brought from rest to its marking speed and back.
struct SpinRequest {
  const AbPlan& ab;
  std::int64_t fpga_hz = 0;
  std::int64_t ticks_per_seed = 1;
  Rational edges_per_unit = 0;  ///< A-B edges a degree or mm
  AxisLimits limits;            ///< all three, in that unit
  /// Rotary axis: where it must be when marking begins, modulo 360 degrees, from where it stood.
  std::optional<Rational> start_deg;
  std::int64_t marking_ticks = 0;     ///< of a run
  Rational edges_per_revolution = 0;  ///< A-B edges of a turn of the workpiece, of a pass
  Rest rest = Rest::next_period;
};

/// The ramp as increments that rise from segment to segment; none above that of marking.
struct Staircase {
  std::vector<SpinSegment> segments;
  double max_acceleration = 0;
  double speed_error = 0;  ///< largest difference from the ramp
};

/// Segments a ramp is cut into, fewer where it has fewer steps of the prescaler.
inline constexpr std::int64_t kSpinSegments = 64;

/// The units a second that the channel's registers make while marking, drift included.
Rational marking_speed(const SpinRequest& request);

/// A jerk-limited ramp (motion) from rest to the marking speed, cut into kSpinSegments of equal length in whole steps
/// of the prescaler and whole seed clocks; the increment of each puts the counter where the ramp is at its end. Fails
/// as motion's planner does.
Result<Staircase> make_staircase(const SpinRequest& request);

/// The spin-up: `rest_seeds` at rest, the staircase, one step that fills up what is missing to a whole A-B edge (its
/// increment lies between those of its neighbours), and as many steps at the marking speed as the start angle, or the
/// way back, asks for.
/// The counter then stands on a whole edge, or, where a seed clock has several steps, less than so many counts beyond
/// it.
Result<AxisSpin> make_spin_up(const SpinRequest& request, const Staircase& stairs, std::int64_t rest_seeds);

/// The spin-down after the marking: as many steps at the marking speed as the place of rest asks for, then the
/// staircase downwards with one step that fills up. The counter comes to rest as the spin-up ends: on a whole A-B
/// period, or less than the steps of a seed clock beyond it.
SpinPlan make_spin_down(const SpinRequest& request, const Staircase& stairs, const SpinPlan& up);

}  // namespace gravure::sync_plan
