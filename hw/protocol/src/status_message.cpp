#include "gravure/protocol/status_message.hpp"

#include <string>

#include "gravure/core/crc32c.hpp"
#include "little_endian.hpp"

namespace gravure::protocol {
namespace {

constexpr std::uint32_t kStatusMark = 0x5356'5247;  // "GRVS"
constexpr std::size_t kCheckedBytes = kStatusBytes - 4;
constexpr std::uint64_t kGateDark = 1;
constexpr std::uint64_t kPartialLine = 2;

std::uint32_t status_checksum(std::span<const std::byte> message) {
  return ~crc32c_continue(kCrc32cStart, message.first(kCheckedBytes));
}

Error nonsense(const std::string& what) {
  return {ErrorCode::device, "status message: " + what + "; the board or the cable is not sound"};
}

}  // namespace

std::array<std::byte, kStatusBytes> encode_status(const BoardStatus& status) {
  std::array<std::byte, kStatusBytes> message{};
  ByteWriter out(message);
  out.put(kStatusMark, 4);
  out.put(status.protocol_version, 2);
  out.put(static_cast<std::uint8_t>(status.state), 1);
  out.put(static_cast<std::uint8_t>(status.fault), 1);
  out.put(status.faults, 1);
  out.put((status.gate_dark ? kGateDark : 0) | (status.partial_line ? kPartialLine : 0), 1);
  out.put(0, 2);
  out.put(status.sequence, 4);
  out.put(status.power_up, 8);
  out.put(status.tick, 8);
  for (const std::uint32_t field : {status.revolution, status.line, status.taken_lines, status.executed_lines,
                                    status.closed_slot, status.level_bytes, status.capacity_bytes}) {
    out.put(field, 4);
  }
  ByteWriter(std::span(message).last(4)).put(status_checksum(message), 4);
  return message;
}

Result<BoardStatus> decode_status(std::span<const std::byte> message) {
  if (message.size() != kStatusBytes) {
    return nonsense(std::to_string(message.size()) + " bytes, must be " + std::to_string(kStatusBytes));
  }
  ByteReader in(message);
  if (in.take(4) != kStatusMark) {
    return nonsense("it does not begin with GRVS");
  }
  BoardStatus status;
  status.protocol_version = static_cast<std::uint16_t>(in.take(2));
  if (status.protocol_version != kProtocolVersion) {
    return Error{ErrorCode::version_mismatch, "the board speaks version " + std::to_string(status.protocol_version) +
                                                  " of the protocol, this program version " +
                                                  std::to_string(kProtocolVersion) + ": update the older one"};
  }
  if (ByteReader(message.last(4)).take(4) != status_checksum(message)) {
    return nonsense("its checksum is wrong");
  }
  const std::uint64_t state = in.take(1);
  const std::uint64_t fault = in.take(1);
  if (state > static_cast<std::uint64_t>(BoardState::stopped) ||
      fault > static_cast<std::uint64_t>(DeviceFault::interlock)) {
    return nonsense("state " + std::to_string(state) + ", fault " + std::to_string(fault) + ": not known");
  }
  status.state = static_cast<BoardState>(state);
  status.fault = static_cast<DeviceFault>(fault);
  status.faults = static_cast<std::uint8_t>(in.take(1));
  const std::uint64_t flags = in.take(1);
  status.gate_dark = (flags & kGateDark) != 0;
  status.partial_line = (flags & kPartialLine) != 0;
  in.take(2);
  status.sequence = static_cast<std::uint32_t>(in.take(4));
  status.power_up = in.take(8);
  status.tick = in.take(8);
  for (std::uint32_t* field : {&status.revolution, &status.line, &status.taken_lines, &status.executed_lines,
                               &status.closed_slot, &status.level_bytes, &status.capacity_bytes}) {
    *field = static_cast<std::uint32_t>(in.take(4));
  }
  return status;
}

}  // namespace gravure::protocol
