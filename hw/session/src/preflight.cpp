#include "gravure/session/preflight.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gravure/protocol/frame.hpp"

namespace gravure::session {
namespace {

std::string megabits(const Rational& bits_per_s) {
  return fmt::format("{:.3f} Mbit/s", to_double(bits_per_s) / 1e6);
}

}  // namespace

LinkDemand link_demand(const ProgramHeader& header) {
  LinkDemand demand;
  demand.frame_bytes = header.line_bytes() + static_cast<std::int64_t>(protocol::kFrameBytes);
  demand.bits_per_s =
      Rational(8 * demand.frame_bytes) * Rational(header.plan.clock.fpga_hz) / Rational(header.plan.line.ticks);
  return demand;
}

Result<void> check_link_rate(const LinkDemand& demand, const DeviceIdentity& device) {
  if (device.link_bits_per_s == 0 || demand.bits_per_s <= Rational(device.link_bits_per_s)) {
    return {};
  }
  return Error{ErrorCode::bad_argument,
               fmt::format("{}: the program uses up {} (frames of {} bytes), the link carries {}: the board would "
                           "starve. Plug it into a faster port, or lower the line rate: raise laser.pulse_divider, or "
                           "scanner.turn_slots, or take fewer pixels a line",
                           device.place, megabits(demand.bits_per_s), demand.frame_bytes,
                           megabits(Rational(device.link_bits_per_s)))};
}

Result<std::int64_t> reserve_bytes(std::int64_t wanted, const LinkDemand& demand, std::int64_t capacity_bytes,
                                   std::int64_t job_lines) {
  if (capacity_bytes < 2 * demand.frame_bytes) {
    return Error{ErrorCode::device, fmt::format("the board buffers {} bytes: it needs room for two frames of {} bytes",
                                                capacity_bytes, demand.frame_bytes)};
  }
  const std::int64_t most = capacity_bytes - demand.frame_bytes;
  if (wanted != 0 && (wanted < demand.frame_bytes || wanted > most)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("--reserve-bytes {}: allowed is {} (a frame) to {} (what the board buffers, less a frame)",
                             wanted, demand.frame_bytes, most)};
  }
  const std::int64_t reserve = wanted != 0 ? wanted : std::max(capacity_bytes / 2, demand.frame_bytes);
  return job_lines < reserve / demand.frame_bytes ? job_lines * demand.frame_bytes : reserve;
}

}  // namespace gravure::session
