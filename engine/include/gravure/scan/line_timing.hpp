#pragma once

#include <cstdint>

#include "gravure/core/error.hpp"
#include "gravure/core/plan.hpp"

namespace gravure::scan {

enum class Direction : std::uint8_t { forward, reverse };

/// When things happen within a line, in pulse slots and FPGA ticks; what a trajectory needs of a Plan.
struct LineTiming {
  std::int64_t fpga_hz = 0;
  std::int64_t ticks_per_slot = 0;
  std::int64_t slots = 0;  ///< of a line, marking window and turn; whole microvectors
  std::int64_t slots_per_microvector = 1;
  std::int64_t pixels = 0;              ///< slots of the marking window
  std::int64_t forward_first_slot = 0;  ///< of the marking window
  std::int64_t reverse_first_slot = 0;  ///< of the marking window, the offset included
  std::int64_t offset_slots = 0;        ///< the pulses of reverse lines are so much later than the scanner's path
  bool bidirectional = true;
  std::int64_t offset_remainder_ticks = 0;  ///< and by so many FPGA ticks more; less than a slot

  std::int64_t ticks() const noexcept { return slots * ticks_per_slot; }
  double slot_s() const noexcept { return static_cast<double>(ticks_per_slot) / static_cast<double>(fpga_hz); }
  std::int64_t first_slot(Direction direction) const noexcept {
    return direction == Direction::forward ? forward_first_slot : reverse_first_slot;
  }
  /// The slot in which a line that runs this way marks the pixel (counted from the left whichever way it runs).
  std::int64_t slot_of_pixel(Direction direction, std::int64_t pixel) const noexcept {
    return direction == Direction::forward ? forward_first_slot + pixel : reverse_first_slot + pixels - 1 - pixel;
  }
  /// When the pulse of a slot fires, in slots of the line: the slot's start, on reverse lines later by the remainder.
  double pulse_at(Direction direction, std::int64_t slot) const noexcept {
    return static_cast<double>(slot) + (direction == Direction::forward ? 0.0
                                                                        : static_cast<double>(offset_remainder_ticks) /
                                                                              static_cast<double>(ticks_per_slot));
  }
};

LineTiming line_timing(const Plan& plan) noexcept;

/// Fails with bad_argument or out_of_range, naming the field, where windows leave the line or counts are not positive.
Result<void> check_timing(const LineTiming& timing);

}  // namespace gravure::scan
