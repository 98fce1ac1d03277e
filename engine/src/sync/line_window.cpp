#include "line_window.hpp"

#include <string>

namespace gravure::sync_plan {
namespace {

std::int64_t forward_first_slot(const LinePlan& line, std::int64_t slots) {
  return (slots - line.pixels) / 2;
}

/// Dark slots after the forward window: where the reverse window starts, without an offset.
std::int64_t mirrored_first_slot(const LinePlan& line, std::int64_t slots) {
  return slots - line.pixels - forward_first_slot(line, slots);
}

}  // namespace

void plan_line(const ScannerSettings& scanner, std::int64_t pixels_per_line, std::int64_t ticks_per_slot,
               LinePlan& line) {
  const std::int64_t step = scanner.slots_per_microvector;
  line.pixels = pixels_per_line;
  line.slots_per_microvector = step;
  line.slots = (pixels_per_line + scanner.turn_slots + step - 1) / step * step;
  line.bidirectional = scanner.bidirectional;
  line.pixel_pitch_um = scanner.pixel_pitch_um;
  if (scanner.bidirectional) {  // without reverse lines there is nothing to delay; plan_warnings() says so
    line.offset_slots = scanner.bidirectional_offset_ticks / ticks_per_slot;
    line.offset_remainder_ticks = scanner.bidirectional_offset_ticks % ticks_per_slot;
  }
}

std::int64_t longest_line_slots(const ScannerSettings& scanner, const LinePlan& line) {
  return line.slots + scanner.max_extra_slots / line.slots_per_microvector * line.slots_per_microvector;
}

bool window_fits(const LinePlan& line, std::int64_t slots) {
  // The reverse window may move from slot 0 to slots - pixels.
  return line.offset_slots >= -mirrored_first_slot(line, slots) && line.offset_slots <= forward_first_slot(line, slots);
}

void check_window(const Job& job, const LinePlan& line, std::int64_t longest_line, std::int64_t ticks_per_slot,
                  Violations& violations) {
  if (window_fits(line, longest_line)) {
    return;
  }
  // Offsets are cut towards zero to whole slots, so one tick less than the next slot still fits.
  const Integer least = -(Integer(mirrored_first_slot(line, longest_line)) + 1) * ticks_per_slot + 1;
  const Integer most = (Integer(forward_first_slot(line, longest_line)) + 1) * ticks_per_slot - 1;
  violations.conflict(ErrorCode::out_of_range, "scanner.bidirectional_offset_ticks",
                      std::to_string(job.scanner.bidirectional_offset_ticks),
                      "moves the marking window of right-to-left lines out of the line; " + to_string(least) + " to " +
                          to_string(most) + " ticks fit a line of " + std::to_string(longest_line) +
                          " slots, more with more scanner.turn_slots");
}

void place_window(LinePlan& line) {
  line.forward_first_slot = forward_first_slot(line, line.slots);
  line.reverse_first_slot = mirrored_first_slot(line, line.slots) + line.offset_slots;
}

}  // namespace gravure::sync_plan
