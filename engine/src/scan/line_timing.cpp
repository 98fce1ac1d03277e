#include "gravure/scan/line_timing.hpp"

#include <fmt/format.h>

#include <limits>

namespace gravure::scan {
namespace {

Result<void> check_range(const char* field, std::int64_t value, std::int64_t low, std::int64_t high) {
  if (value >= low && value <= high) {
    return {};
  }
  return Error{ErrorCode::out_of_range, fmt::format("scan: {} = {}: must be {} to {}", field, value, low, high)};
}

}  // namespace

LineTiming line_timing(const Plan& plan) noexcept {
  const LinePlan& line = plan.line;
  return {plan.clock.fpga_hz,
          plan.clock.ticks_per_slot,
          line.slots,
          line.slots_per_microvector,
          line.pixels,
          line.forward_first_slot,
          line.reverse_first_slot,
          line.offset_slots,
          line.bidirectional,
          line.offset_remainder_ticks};
}

Result<void> check_timing(const LineTiming& timing) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  GRAVURE_CHECK(check_range("fpga_hz", timing.fpga_hz, 1, kMost));
  GRAVURE_CHECK(check_range("ticks_per_slot", timing.ticks_per_slot, 1, 1'000'000'000));
  GRAVURE_CHECK(check_range("slots", timing.slots, 1, kMostSlotsPerLine));
  GRAVURE_CHECK(check_range("slots_per_microvector", timing.slots_per_microvector, 1, timing.slots));
  if (timing.slots % timing.slots_per_microvector != 0) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("scan: slots = {}: must be a multiple of slots_per_microvector = {}", timing.slots,
                             timing.slots_per_microvector)};
  }
  GRAVURE_CHECK(check_range("pixels", timing.pixels, 1, timing.slots));
  const std::int64_t latest = timing.slots - timing.pixels;
  GRAVURE_CHECK(check_range("forward_first_slot", timing.forward_first_slot, 0, latest));
  if (!timing.bidirectional) {
    return {};
  }
  GRAVURE_CHECK(check_range("reverse_first_slot", timing.reverse_first_slot, 0, latest));
  return check_range("offset_slots", timing.offset_slots, timing.reverse_first_slot - latest,
                     timing.reverse_first_slot);
}

}  // namespace gravure::scan
