#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "gravure/core/error.hpp"
#include "gravure/core/path_expand.hpp"
#include "gravure/core/path_motion.hpp"
#include "gravure/core/plan.hpp"

namespace gravure {

/// How far pulses lie from where they belong, because a pulse can only come in a slot.
struct PathSpacing {
  std::int64_t pulses = 0;  ///< placed, fired or not
  std::int64_t fired = 0;
  double max_error_um = 0;  ///< along the path, from where the pulse belongs
  double rms_error_um = 0;
  double half_slot_um = 0;    ///< half a slot at the greatest speed: no error is larger
  double max_speed_mm_s = 0;  ///< of the spot along the path, between set-points as well (core/path_expand.hpp)
  double least_slots = 0;     ///< fewest slots from a pulse to the next as the path asks for: never below 1
};

/// Puts the pulses of a path into slots, period by period: pulse i belongs where (i + 1/2) pitches of the path are
/// covered, and comes in the slot nearest to that moment.
class PathSlots {
 public:
  /// `plan` and `pulses` outlive it.
  PathSlots(const Plan& plan, const PathPulses& pulses);

  /// The next period (line) of the path: `bits` are the line's, cleared before. Fails with out_of_range, naming pulse,
  /// time and speed, where two pulses would need the same slot.
  Result<void> place(const PathWindow& window, std::span<std::byte> bits);
  /// After the last: bad_argument where the path ends before the last pulse.
  Result<void> finish() const;
  PathSpacing spacing() const;

 private:
  Result<void> place_pulse(double moment_slots, double wrong_counts, std::span<std::byte> bits);

  const Plan& plan_;
  const PathPulses& pulses_;
  double counts_per_mm_;
  double pitch_counts_;
  std::int64_t line_ = 0;
  std::int64_t next_ = 0;  ///< pulse
  std::int64_t last_slot_ = -1;
  bool carried_ = false;  ///< the first slot of the next line fires
  double last_moment_ = -1;
  double squares_ = 0;
  PathSpacing spacing_;
};

}  // namespace gravure
