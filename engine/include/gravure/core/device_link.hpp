#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "gravure/core/device_fault.hpp"
#include "gravure/core/error.hpp"

namespace gravure {

/// Which board it is, as it and its bus say.
struct DeviceIdentity {
  std::string serial;
  std::string product;
  std::string place;                   ///< "bus 1, device 4", a folder, a file
  std::uint16_t protocol_version = 0;  ///< what goes over the wire (docs/protocol.md)
  std::int64_t link_bits_per_s = 0;    ///< that the bus can carry to the board; 0: not known
};

enum class BoardState : std::uint8_t {
  idle,     ///< no lines run
  filling,  ///< the position is set, frames are taken, no line has begun
  running,  ///< lines run
  stopped,  ///< by a fault, which stands
};
std::string to_string(BoardState state);

/// What a board says of itself whenever something has changed (bulk IN). Lines count since the position was set.
struct BoardStatus {
  std::uint16_t protocol_version = 0;
  BoardState state = BoardState::idle;
  DeviceFault fault = DeviceFault::none;  ///< the first since the last acknowledge
  std::uint8_t faults = 0;                ///< all of them: bit 0 sequence to bit 5 interlock
  bool gate_dark = true;
  bool partial_line = false;         ///< the fault came while line `executed_lines` ran
  std::uint32_t sequence = 0;        ///< of status messages: a gap is a lost one
  std::uint64_t power_up = 0;        ///< another number each time the board has lost its state
  std::uint64_t tick = 0;            ///< FPGA ticks since go
  std::uint32_t revolution = 0;      ///< of the line that runs or comes next
  std::uint32_t line = 0;            ///< likewise
  std::uint32_t taken_lines = 0;     ///< whose frames are through, in sequence and whole
  std::uint32_t executed_lines = 0;  ///< that have passed from their first slot to the last
  std::uint32_t closed_slot = 0;     ///< partial_line: slots of it that had passed when the gate closed
  std::uint32_t level_bytes = 0;     ///< bytes of the stream that wait in the board, frames and parts of one
  std::uint32_t capacity_bytes = 0;  ///< most that can
};

/// The wire to a board: USB, an emulated board in this process, or a recorded session. Registers are those of
/// docs/registers.md; the stream is that of docs/protocol.md. One thread at a time.
///
/// Errors: device (refused, stalled, unplugged: the message says which), timeout, version_mismatch, io. A link that has
/// failed once goes on failing, but for writes of registers where only a bulk endpoint has failed; the board closes its
/// gate by itself when its host is silent.
class DeviceLink {
 public:
  using Milliseconds = std::chrono::milliseconds;

  virtual ~DeviceLink() = default;
  virtual const DeviceIdentity& identity() const noexcept = 0;

  virtual Result<std::uint32_t> read_register(std::uint8_t address) = 0;
  virtual Result<void> write_register(std::uint8_t address, std::uint32_t value) = 0;

  /// Hands over bytes of the stream, in order, and returns how many were taken: fewer where the link is full, 0 where
  /// it stayed so for `patience`. What was taken may still be on its way. Any cut between calls is allowed.
  virtual Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds patience) = 0;
  /// Waits until all that was taken is in the board; false where that takes longer.
  virtual Result<bool> drain(Milliseconds patience) = 0;
  /// Drops what is still on its way (before the position is set anew).
  virtual Result<void> abandon() = 0;

  /// The newest status that has not been given yet; none where none came in time. Older ones are skipped.
  virtual Result<std::optional<BoardStatus>> next_status(Milliseconds patience) = 0;
};

}  // namespace gravure
