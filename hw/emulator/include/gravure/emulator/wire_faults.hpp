#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::emulator {

/// What can go wrong on purpose on the wire, in the board, and around it.
enum class WireFaultKind : std::uint8_t {
  // In the board, at a slot of a line.
  underrun,   ///< the line's bits are not there
  silence,    ///< the watchdog finds the host silent
  interlock,  ///< the machine's interlock opens
  power,      ///< the board loses its power, and comes back without its state
  // With the frame of a line, on its way through the board.
  checksum,   ///< one of its bits is turned over
  lost,       ///< it is left out
  duplicate,  ///< it comes twice
  shape,      ///< its window lies past the end of the line
  // At a byte of the stream, counted from the board's power-up.
  corrupt,  ///< a bit of it is turned over
  full,     ///< from it on the board never takes a byte again
  // Of the link, at a byte of the stream that it carries.
  stall,       ///< it refuses to go on
  timeout,     ///< it takes no byte and gives no status any more
  disconnect,  ///< it is gone, and the board is without a host
  short_take,  ///< a transfer ends before it
  delay,       ///< the statuses of the next calls come late
  reorder,     ///< two statuses come in the wrong order
};
std::string to_string(WireFaultKind kind);

struct WireFault {
  WireFaultKind kind = WireFaultKind::underrun;
  std::int64_t line = -1;  ///< over the whole job; -1: a byte is what counts
  std::int64_t slot = 0;   ///< of that line
  std::int64_t byte = -1;
  friend bool operator==(const WireFault&, const WireFault&) = default;
};

/// "KIND@line=N", "KIND@line=N+SLOT" or "KIND@byte=N", as the kind has it. bad_argument names what is allowed.
Result<WireFault> parse_wire_fault(std::string_view text);
/// As parse_wire_fault() takes it.
std::string to_string(const WireFault& fault);

/// Faults that are still to come. Each happens once.
class WireFaults {
 public:
  WireFaults() = default;
  explicit WireFaults(std::vector<WireFault> faults) : left_(std::move(faults)) {}

  /// Takes out the one that hits a slot of this line, or its frame.
  std::optional<WireFault> at_line(std::int64_t line);
  std::optional<WireFault> at_frame(std::int64_t line);
  /// Takes out one of a kind among the bytes first .. end - 1.
  std::optional<WireFault> at_byte(WireFaultKind kind, std::int64_t first, std::int64_t end);
  /// The place of the first of a kind, which stays; none where there is none.
  std::optional<std::int64_t> first_byte(WireFaultKind kind) const;
  /// Bytes are counted from `bytes` on from now on.
  void rebase(std::int64_t bytes);
  const std::vector<WireFault>& left() const noexcept { return left_; }

 private:
  std::vector<WireFault> left_;
};

}  // namespace gravure::emulator
