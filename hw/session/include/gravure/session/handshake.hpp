#pragma once

#include <cstdint>
#include <vector>

#include "gravure/core/device_link.hpp"
#include "gravure/core/line_device.hpp"

namespace gravure::session {

/// What a board says of itself when it is opened (docs/registers.md).
struct BoardInfo {
  std::uint32_t map_version = 0;
  int counter_bits = 0;
  int fifo_bits = 0;
  std::int64_t clock_multiplier = 0;
  std::vector<std::uint32_t> descriptors;  ///< of the ROM, without the 0 behind the last
};

/// Reads magic, version of the register map, sizes and descriptors. device where it is none of our boards or says what
/// no board can; version_mismatch, naming both versions.
Result<BoardInfo> shake_hands(DeviceLink& link);

/// device, with one line for each thing, where this board cannot run that setup: its clocks, counters, or a line that
/// does not fit twice into the line FIFO, or that takes longer to come than to run.
Result<void> check_board(const BoardInfo& board, const DeviceSetup& setup);

}  // namespace gravure::session
